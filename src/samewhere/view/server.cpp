#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <sys/socket.h>

#include <samewhere/core/channel.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/stage_thread.hpp>
#include <samewhere/view/connection.hpp>
#include <samewhere/view/request_head.hpp>
#include <samewhere/view/server.hpp>

namespace samewhere::view {
namespace {

constexpr int kNumThreads = kMaxStreams + 4;  // a stream takes one
constexpr std::size_t kMaxWaiting = 64;       // connections
constexpr int kBacklog = 128;
constexpr double kTurn_s = 0.1;      // between two looks of a stream
constexpr int kTurnsOfSilence = 10;  // then a comment shows whether the client is there
constexpr int kStartTurns = 2000;
constexpr std::size_t kPart_bytes = 1'000'000;
constexpr const char* kHtml = "text/html; charset=utf-8";
constexpr const char* kText = "text/plain; charset=utf-8";

// Counts an open stream.
class StreamSlot {
 public:
  explicit StreamSlot(core::Guarded<int>& num) : num_(num) {
    is_taken_ = num_.with([](int& open) { return open < kMaxStreams && ++open > 0; });
  }
  StreamSlot(const StreamSlot&) = delete;
  StreamSlot& operator=(const StreamSlot&) = delete;
  ~StreamSlot() {
    if (is_taken_) num_.with([](int& open) { return --open; });
  }
  bool is_taken() const { return is_taken_; }

 private:
  core::Guarded<int>& num_;
  bool is_taken_ = false;
};

// The accepting thread only hands connections over.
class NoQueue : public httplib::TaskQueue {
 public:
  using Enqueued = decltype(std::declval<httplib::TaskQueue&>().enqueue({}));
  Enqueued enqueue(std::function<void()> task) override {
    task();
    return static_cast<Enqueued>(true);
  }
  void shutdown() override {}
};

void answer_text(httplib::Response& response, int status, const std::string& text) {
  response.status = status;
  response.set_content(text, kText);
}

// In parts, without a copy.
void answer_page(httplib::Response& response, const Page& page) {
  response.set_content_provider(
      page->size(), kHtml, [page](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
        return sink.write(page->data() + offset, std::min(length, kPart_bytes));
      });
}

// Runs `work`; bad input becomes an answer.
template <class Work>
void guarded(httplib::Response& response, const Work& work) {
  try {
    work();
  } catch (const core::InputError& error) {
    answer_text(response, 400, error.what());
  }
}

}  // namespace

class Server::Http : private httplib::Server {
 public:
  Http(const Place& place, const std::string& token, Routes routes)
      : place_(bound(place)), token_(token), access_(place_, token), routes_(std::move(routes)) {
    add_routes();
    new_task_queue = [] { return new NoQueue; };
    for (int i = 0; i < kNumThreads; ++i)
      workers_.push_back(std::make_unique<core::WorkerThread>([this] { work(); }));
    accepting_ = std::make_unique<core::WorkerThread>([this] { listen_after_bind(); });
    for (int i = 0; i < kStartTurns && !is_running(); ++i) closing_.is_open_for(1e-3);
  }

  ~Http() override {
    closing_.close();
    stop();
    accepting_.reset();
    waiting_.close();
    workers_.clear();
  }

  std::string url() const {
    return fmt::format("http://{}/{}", host_of(place_), token_.empty() ? "" : "?token=" + token_);
  }
  int port() const { return place_.port; }
  int num_streams() const { return num_streams_.get(); }

 private:
  using Request = httplib::Request;
  using Response = httplib::Response;

  Place bound(Place place) {
    // the library would share a port with other programs
    socket_t listening = INVALID_SOCKET;
    set_socket_options([&listening](socket_t socket) {
      listening = socket;
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
    });
    bool is_bound = bind_to_port(place.address.c_str(), place.port);
    if (!is_bound && !place.is_port_wanted) {
      const int port = bind_to_any_port(place.address.c_str());
      is_bound = port > 0;
      if (is_bound) place.port = port;
    }
    set_socket_options([](socket_t) {});
    if (is_bound) ::listen(listening, kBacklog);  // the library has fewer, and clients would wait
    if (is_bound) return place;
    throw core::InputError(
        host_of(place) +
        ": cannot be served: it is taken, or not of this machine; expected another port");
  }

  // In the accepting thread.
  bool process_and_close_socket(socket_t socket) override {
    const bool is_refused =
        waiting_.send_limited(socket, kMaxWaiting, [](socket_t) { return false; }) > 0;
    if (is_refused) refuse_at_once(socket);
    return !is_refused;
  }

  void work() {
    while (const std::optional<socket_t> socket = waiting_.receive()) {
      Connection connection(*socket, [this] { return closing_.is_ready(); });
      if (connection.read_head()) answer(connection);
    }
  }

  void answer(Connection& connection) {
    bool is_closed = false;
    serve(*this, connection, is_closed);
  }

  // Versions of the library differ in what they ask for.
  template <class Self>
  static void serve(Self& self, httplib::Stream& stream, bool& is_closed) {
    if constexpr (requires { self.process_request(stream, true, is_closed, nullptr); })
      self.process_request(stream, true, is_closed, nullptr);
    else
      self.process_request(stream, "", 0, "", 0, true, is_closed, nullptr);
  }

  void add_routes() {
    set_payload_max_length(kMaxBody_bytes);
    set_pre_routing_handler(
        [this](const Request& request, Response& response) { return check(request, response); });
    for (const auto& [path, page] : routes_.pages)
      Get(path, [make = page](const Request&, Response& response) {
        guarded(response, [&] { answer_page(response, make()); });
      });
    for (const auto& [path, open] : routes_.streams)
      Get(path, [this, make = open](const Request&, Response& response) {
        guarded(response, [&] { stream(make, response); });
      });
    for (const auto& [path, action] : routes_.actions)
      Post(path, [act = action](const Request& request, Response& response) {
        guarded(response, [&] {
          const Answer answer = act(request.body);
          response.status = answer.status;
          response.set_content(answer.text, "application/json");
        });
      });
  }

  HandlerResponse check(const Request& request, Response& response) const {
    response.set_header("Cache-Control", "no-store");
    response.set_header("X-Content-Type-Options", "nosniff");
    response.set_header("Referrer-Policy", "no-referrer");
    response.set_header("Cross-Origin-Resource-Policy", "same-origin");
    response.set_header("Content-Security-Policy", "frame-ancestors 'self'");
    const auto refusal = access_.refusal({.host = request.get_header_value("host"),
                                          .origin = request.get_header_value("origin"),
                                          .fetch_site = request.get_header_value("sec-fetch-site"),
                                          .token = request.get_param_value("token"),
                                          .is_page = routes_.pages.contains(request.path)});
    if (refusal) answer_text(response, 403, *refusal + "\n");
    const bool is_json = request.get_header_value("content-type") == "application/json";
    if (!refusal && request.method == "POST" && !is_json)
      answer_text(response, 415, "expected application/json\n");
    return response.status > 0 ? HandlerResponse::Handled : HandlerResponse::Unhandled;
  }

  void stream(const std::function<NextEvents()>& open, Response& response) {
    const auto slot = std::make_shared<StreamSlot>(num_streams_);
    if (!slot->is_taken()) return answer_text(response, 503, "too many pages are open\n");
    response.set_chunked_content_provider(
        "text/event-stream",
        [this, slot, next = open(), num_silent = 0](std::size_t, httplib::DataSink& sink) mutable {
          return send_next(next, num_silent, sink);
        });
  }
  // What is new, or after some silence a comment, by which a broken connection is noticed. False:
  // the connection is broken, or the server ends.
  bool send_next(const NextEvents& next, int& num_silent, httplib::DataSink& sink) {
    const std::optional<std::string> events = next();
    if (!events) {
      sink.done();
      return true;
    }
    num_silent = events->empty() ? num_silent + 1 : 0;
    if (events->empty() && num_silent < kTurnsOfSilence) return closing_.is_open_for(kTurn_s);
    const std::string text = events->empty() ? ":\n\n" : *events;
    num_silent = 0;
    return sink.write(text.data(), text.size()) && closing_.is_open_for(kTurn_s);
  }

  Place place_;
  std::string token_;
  Access access_;
  Routes routes_;
  mutable core::Guarded<int> num_streams_;
  core::Channel<int> closing_{1};
  core::Channel<socket_t> waiting_{kMaxWaiting};
  std::vector<std::unique_ptr<core::WorkerThread>> workers_;
  std::unique_ptr<core::WorkerThread> accepting_;
};

Server::Server(const Place& place, const std::string& token, Routes routes)
    : http_(std::make_unique<Http>(place, token, std::move(routes))) {}
Server::~Server() = default;

std::string Server::url() const { return http_->url(); }
int Server::port() const { return http_->port(); }
int Server::num_streams() const { return http_->num_streams(); }

}  // namespace samewhere::view
