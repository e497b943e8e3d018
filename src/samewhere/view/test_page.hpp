#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <samewhere/core/stage_thread.hpp>
#include <samewhere/view/live_view.hpp>
#include <samewhere/view/test_client.hpp>

namespace samewhere::view {

inline int port_of(const LiveView& view) {
  return std::stoi(view.url().substr(view.url().rfind(':') + 1));
}

struct Event {
  std::string name;
  nlohmann::json data;
};

// Of the answer to open_events() and what came after it, a stream of chunks; those that are whole.
inline std::vector<Event> events_in(const std::string& answer) {
  std::string text;
  std::size_t at = answer.find("\r\n\r\n") + 4;
  while (at < answer.size()) {
    const std::size_t size = std::stoul(answer.substr(at), nullptr, 16);
    at = answer.find("\r\n", at) + 2;
    text += answer.substr(at, size);
    at += size + 2;
  }
  std::vector<Event> events;
  for (at = text.find("event: "); at != std::string::npos; at = text.find("event: ", at)) {
    const std::size_t end = text.find('\n', at);
    const std::size_t data_end = text.find('\n', end + 1);
    if (data_end == std::string::npos) break;
    events.push_back({text.substr(at + 7, end - at - 7),
                      nlohmann::json::parse(text.substr(end + 7, data_end - end - 7))});
    at = data_end;
  }
  return events;
}

inline std::string open_events(TestClient& client, int port) {
  client.send(fmt::format("GET /events HTTP/1.1\r\nHost: localhost:{}\r\n\r\n", port));
  return client.receive(20.0, "\r\n\r\n");
}

// A page that is open from here on, and keeps what it is told.
class TestPage {
 public:
  explicit TestPage(const LiveView& view)
      : client_(port_of(view)), text_(open_events(client_, port_of(view))), reader_([this] {
          while (!is_closed_.get()) {
            const std::string more = client_.receive(0.1);
            text_.with([&](std::string& text) {
              text += more;
              return 0;
            });
          }
        }) {}
  TestPage(const TestPage&) = delete;
  TestPage& operator=(const TestPage&) = delete;
  ~TestPage() { is_closed_.set(true); }

  std::vector<Event> events() const { return events_in(text_.get()); }

 private:
  TestClient client_;
  core::Guarded<std::string> text_;
  core::Guarded<bool> is_closed_;
  core::WorkerThread reader_;  // last: it ends first
};

}  // namespace samewhere::view
