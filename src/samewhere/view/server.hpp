#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include <samewhere/view/access.hpp>
#include <samewhere/view/place.hpp>

namespace samewhere::view {

// The next server-sent events of a stream, as text; empty: there are none now. Nothing: the stream
// ends. Called in a thread of the server.
using NextEvents = std::function<std::optional<std::string>()>;

struct Answer {
  int status = 200;
  std::string text;
};

// HTML, shared by all that read it.
using Page = std::shared_ptr<const std::string>;

// What is served: these paths and nothing else, in particular no files by name. Called in threads
// of the server, several at a time. What they throw as InputError becomes status 400 with its
// message.
struct Routes {
  std::map<std::string, std::function<Page()>> pages;
  std::map<std::string, std::function<NextEvents()>> streams;
  // Given the body of the request, which is JSON; returns JSON.
  std::map<std::string, std::function<Answer(const std::string& body)>> actions;
};

inline constexpr int kMaxStreams = 16;

// An HTTP server of limited size: kMaxStreams streams and few threads for other requests; what
// comes beyond is refused at once. A client that sends or reads too slowly is dropped. Works until
// it is destroyed.
class Server {
 public:
  // Throws InputError if the place cannot be served. Empty token: none is asked for.
  Server(const Place& place, const std::string& token, Routes routes);
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  ~Server();

  // For a browser, with the token.
  std::string url() const;
  int port() const;
  // Open now: how many pages look.
  int num_streams() const;

 private:
  class Http;
  std::unique_ptr<Http> http_;
};

}  // namespace samewhere::view
