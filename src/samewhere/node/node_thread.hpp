#pragma once

#include <vector>

#include <samewhere/core/channel.hpp>
#include <samewhere/core/stage_thread.hpp>
#include <samewhere/node/node.hpp>

namespace samewhere::node {

// A node in a thread of its own, with a bounded inbox: a transport posts from any thread. Images
// that come faster than they are tracked are dropped, oldest first, and counted.
class NodeThread {
 public:
  // Arguments as in Node.
  NodeThread(const Config& config, const Options& options, Publisher& publisher,
             run::Watcher* watcher = nullptr);
  NodeThread(const NodeThread&) = delete;
  NodeThread& operator=(const NodeThread&) = delete;
  // What waits is not done.
  ~NodeThread();

  // Never waits. False if the message was dropped, because the node has ended or a thousand others
  // wait.
  bool post(Incoming incoming);
  // Waits until the node has done what came before, and this.
  Answer ask(const Command& command);
  // Does what waits, then Node::finish(). Throws what the publisher threw.
  std::vector<StampedPose> finish();

 private:
  std::size_t max_images_;
  core::Channel<Incoming> inbox_;
  core::Guarded<std::uint64_t> num_dropped_;
  Node node_;
  core::WorkerThread worker_;  // last: it ends first
};

}  // namespace samewhere::node
