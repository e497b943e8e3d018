#include <memory>
#include <utility>

#include <samewhere/node/node_thread.hpp>

namespace samewhere::node {
namespace {

constexpr std::size_t kMaxWaiting = 1000;

bool is_image(const Incoming& incoming) { return std::holds_alternative<ImageIn>(incoming); }

std::size_t images_of(const Config& config) {
  const std::size_t num_streams = config.cameras == Cameras::kMono ? 1 : 2;
  return num_streams * static_cast<std::size_t>(config.queue_frames);
}

}  // namespace

NodeThread::NodeThread(const Config& config, const Options& options, Publisher& publisher,
                       run::Watcher* watcher)
    : max_images_(images_of(config)),
      inbox_(kMaxWaiting + max_images_),
      node_(config, options, publisher, watcher),
      worker_([this] {
        while (std::optional<Incoming> incoming = inbox_.receive()) {
          node_.count_dropped(num_dropped_.exchange(0));
          node_.take(std::move(*incoming));
        }
      }) {}

NodeThread::~NodeThread() {
  inbox_.close();
  while (inbox_.receive()) continue;
}

bool NodeThread::post(Incoming incoming) {
  const bool is_of_images = is_image(incoming);
  const std::size_t num_dropped = inbox_.send_limited(std::move(incoming), max_images_, is_image);
  if (num_dropped > 0 && is_of_images)
    num_dropped_.with([&](std::uint64_t& sum) { sum += num_dropped; });
  return num_dropped == 0 || is_of_images;
}

Answer NodeThread::ask(const Command& command) {
  const auto answer = std::make_shared<core::Channel<Answer>>(1);
  if (!post(CommandIn{command, answer}))
    return {.is_done = false, .text = "the node has ended, or too many messages wait"};
  return answer->receive().value_or(Answer{});
}

std::vector<StampedPose> NodeThread::finish() {
  inbox_.close();
  worker_.join();
  return node_.finish();
}

}  // namespace samewhere::node
