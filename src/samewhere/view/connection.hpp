#pragma once

#include <functional>
#include <string>

#include <httplib.h>

namespace samewhere::view {

// One connection of a client, with limits that the HTTP library lacks: the head of the request
// comes within kMaxHead_bytes and kRequestLimit_s, and what is written is read at
// kSlowestReader_bytes_s or faster. Otherwise it counts as broken. Closes the socket.
class Connection : public httplib::Stream {
 public:
  // `is_over`: the server ends and waits for no client any more.
  Connection(int socket, std::function<bool()> is_over);
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection() override;

  // False: refused, and the client told so.
  bool read_head();
  // An answer without content; for what is refused.
  void refuse(int status);

  // As in httplib::Stream, of which each version has some of these.
  // NOLINTBEGIN(modernize-use-override)
  virtual bool is_readable() const;
  virtual bool is_writable() const;
  virtual bool wait_readable() const { return true; }
  virtual bool wait_writable() const { return is_writable(); }
  virtual time_t duration() const { return 0; }
  // NOLINTEND(modernize-use-override)
  ssize_t read(char* bytes, size_t size) override;
  ssize_t write(const char* bytes, size_t size) override;
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  socket_t socket() const override { return socket_; }

 private:
  bool wait_for(short events, double until_s) const;

  int socket_;
  std::function<bool()> is_over_;
  double begin_s_;
  std::string received_;  // and not yet read
};

// Status 503, for a connection that comes when too many wait; closes the socket without a wait.
void refuse_at_once(int socket);

}  // namespace samewhere::view
