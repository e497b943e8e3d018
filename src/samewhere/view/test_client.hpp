#pragma once

#include <string>
#include <string_view>
#include <utility>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <samewhere/core/channel.hpp>

namespace samewhere::view {

// A connection to a port of this machine that sends what a test wants it to.
class TestClient {
 public:
  // small_window: takes little at a time, as a slow reader does.
  explicit TestClient(int port, bool small_window = false)
      : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    const int few_bytes = 4096;
    if (small_window) ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &few_bytes, sizeof(few_bytes));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    is_connected_ = ::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address)) == 0;
  }
  TestClient(TestClient&& other) noexcept
      : socket_(std::exchange(other.socket_, -1)), is_connected_(other.is_connected_) {}
  TestClient(const TestClient&) = delete;
  TestClient& operator=(const TestClient&) = delete;
  ~TestClient() {
    if (socket_ >= 0) ::close(socket_);
  }

  bool is_connected() const { return is_connected_; }

  // False once the server has closed.
  bool send(std::string_view text) {
    while (!text.empty()) {
      const ssize_t num = ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL);
      if (num <= 0) return false;
      text.remove_prefix(static_cast<std::size_t>(num));
    }
    return true;
  }

  // What comes until the server closes, or nothing comes for so long, or it has `until`.
  std::string receive(double silence_s = 8.0, std::string_view until = "") {
    std::string text;
    pollfd waiting{socket_, POLLIN, 0};
    while (::poll(&waiting, 1, static_cast<int>(1000 * silence_s)) > 0) {
      char bytes[65536];
      const ssize_t num = ::recv(socket_, bytes, sizeof(bytes), 0);
      if (num <= 0) break;
      text.append(bytes, static_cast<std::size_t>(num));
      if (!until.empty() && text.find(until) != std::string::npos) break;
    }
    return text;
  }

 private:
  int socket_;
  bool is_connected_ = false;
};

inline void rest(double seconds) { core::Channel<int>(1).is_open_for(seconds); }

// The answer to a request with such headers, each with its line end.
inline std::string ask(int port, const std::string& request_line, const std::string& headers = "",
                       const std::string& body = "") {
  TestClient client(port);
  const bool has_host = headers.find("Host:") != std::string::npos;
  client.send(request_line + " HTTP/1.1\r\n" +
              (has_host ? "" : fmt::format("Host: 127.0.0.1:{}\r\n", port)) + headers + "\r\n" +
              body);
  return client.receive();
}

inline std::string post(int port, const std::string& path, const std::string& body,
                        const std::string& headers = "Content-Type: application/json\r\n") {
  return ask(port, "POST " + path, fmt::format("{}Content-Length: {}\r\n", headers, body.size()),
             body);
}

// 0: there is none.
inline int status_of(const std::string& answer) {
  return answer.starts_with("HTTP/1.1 ") ? std::stoi(answer.substr(9, 3)) : 0;
}

}  // namespace samewhere::view
