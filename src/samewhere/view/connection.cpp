#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <samewhere/view/connection.hpp>
#include <samewhere/view/request_head.hpp>

namespace samewhere::view {
namespace {

constexpr double kRequestLimit_s = 4.0;
constexpr double kAnswerLimit_s = 4.0;
constexpr double kSlowestReader_bytes_s = 100e3;
constexpr double kFarewell_s = 0.2;
constexpr double kLook_s = 0.1;

double clock_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string refusal_text(int status) {
  return fmt::format("HTTP/1.1 {} refused\r\nConnection: close\r\nContent-Length: 0\r\n\r\n",
                     status);
}

}  // namespace

void refuse_at_once(int socket) {
  const std::string answer = refusal_text(503);
  ::send(socket, answer.data(), answer.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  ::close(socket);
}

Connection::Connection(int socket, std::function<bool()> is_over)
    : socket_(socket), is_over_(std::move(is_over)), begin_s_(clock_s()) {}

// What the client still sends is read for a moment: closed before, the system would take back what
// was answered.
Connection::~Connection() {
  ::shutdown(socket_, SHUT_WR);
  const double until_s = clock_s() + kFarewell_s;
  char bytes[4096];
  for (std::size_t left = kMaxBody_bytes; left > 0 && wait_for(POLLIN, until_s);) {
    const ssize_t num = ::recv(socket_, bytes, sizeof(bytes), MSG_DONTWAIT);
    if (num <= 0) break;
    left -= std::min(left, static_cast<std::size_t>(num));
  }
  ::close(socket_);
}

bool Connection::wait_for(short events, double until_s) const {
  while (!is_over_()) {
    pollfd waiting{socket_, events, 0};
    const double left_s = std::clamp(until_s - clock_s(), 0.0, kLook_s);
    const int num_ready = ::poll(&waiting, 1, static_cast<int>(std::ceil(1000.0 * left_s)));
    if (num_ready > 0) return true;
    if (clock_s() >= until_s) return false;
  }
  return false;
}

bool Connection::read_head() {
  constexpr std::string_view kEnd = "\r\n\r\n";
  std::string head;
  std::size_t end = std::string::npos;
  while (end == std::string::npos) {
    char bytes[4096];
    const ssize_t num =
        wait_for(POLLIN, begin_s_ + kRequestLimit_s) ? ::recv(socket_, bytes, sizeof(bytes), 0) : 0;
    if (num <= 0) return false;
    const std::size_t from = head.size() < kEnd.size() ? 0 : head.size() - kEnd.size();
    head.append(bytes, static_cast<std::size_t>(num));
    end = head.find(kEnd, from);
    if (std::min(end, head.size()) > kMaxHead_bytes) {
      refuse(431);
      return false;
    }
  }
  end += kEnd.size();
  const RequestHead checked = checked_head(std::string_view(head).substr(0, end));
  if (checked.status != 0) {
    refuse(checked.status);
    return false;
  }
  received_ = checked.text + head.substr(end);
  return true;
}

void Connection::refuse(int status) {
  const std::string answer = refusal_text(status);
  write(answer.data(), answer.size());
}

bool Connection::is_readable() const {
  return !received_.empty() || wait_for(POLLIN, begin_s_ + kRequestLimit_s);
}

// False once the client has gone.
bool Connection::is_writable() const {
  pollfd waiting{socket_, POLLRDHUP, 0};
  return ::poll(&waiting, 1, 0) == 0;
}

ssize_t Connection::read(char* bytes, size_t size) {
  if (received_.empty()) {
    if (!wait_for(POLLIN, begin_s_ + kRequestLimit_s)) return -1;
    return ::recv(socket_, bytes, size, 0);
  }
  const std::size_t num = std::min(size, received_.size());
  std::memcpy(bytes, received_.data(), num);
  received_.erase(0, num);
  return static_cast<ssize_t>(num);
}

ssize_t Connection::write(const char* bytes, size_t size) {
  const double until_s =
      clock_s() + kAnswerLimit_s + static_cast<double>(size) / kSlowestReader_bytes_s;
  std::size_t num_written = 0;
  while (num_written < size) {
    if (!wait_for(POLLOUT, until_s)) return -1;
    const ssize_t num =
        ::send(socket_, bytes + num_written, size - num_written, MSG_DONTWAIT | MSG_NOSIGNAL);
    if (num < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    if (num <= 0) return -1;
    num_written += static_cast<std::size_t>(num);
  }
  return static_cast<ssize_t>(size);
}

// Requests are judged by what they say, not by where they come from.
void Connection::get_remote_ip_and_port(std::string& ip, int& port) const {
  ip.clear();
  port = 0;
}
void Connection::get_local_ip_and_port(std::string& ip, int& port) const {
  ip.clear();
  port = 0;
}

}  // namespace samewhere::view
