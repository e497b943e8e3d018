#pragma once

#include <memory>

#include <samewhere/core/channel.hpp>
#include <samewhere/core/stage_thread.hpp>
#include <samewhere/node/keyframe_depths.hpp>
#include <samewhere/node/publisher.hpp>

namespace samewhere::node {

struct GridJob {
  messages::Header header;
  std::shared_ptr<const Map> map;
  SharedDepths depths;
};

// Makes occupancy grids beside tracking; with `has_thread` false, in the
// caller's thread. A job that waits is replaced by a newer one.
class GridThread {
 public:
  GridThread(const dense::Config& config, bool has_thread, Publisher& publisher);
  GridThread(const GridThread&) = delete;
  GridThread& operator=(const GridThread&) = delete;
  // Does what waits.
  ~GridThread();

  void make(GridJob job);
  // Why the last job gave no grid; empty: it gave one.
  std::string why_none() const { return why_none_.get(); }

 private:
  void work(const GridJob& job);

  dense::Config config_;
  Publisher& publisher_;
  core::Guarded<std::string> why_none_;
  core::Channel<GridJob> jobs_{1};
  std::optional<core::WorkerThread> worker_;  // last: it ends first
};

}  // namespace samewhere::node
