#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <opencv2/core/mat.hpp>

#include <samewhere/event.hpp>
#include <samewhere/node/grid_thread.hpp>
#include <samewhere/node/keyframe_depths.hpp>
#include <samewhere/node/publisher.hpp>

namespace samewhere::node {

// The occupancy grid of a node with depth images: takes their depth and the events of the session,
// gives a grid whenever the map has changed.
class GridOutput {
 public:
  struct Settings {
    dense::Config dense;
    double period_s = 5.0;   // between two grids, at least
    bool has_thread = true;  // grids are made beside tracking
  };
  // The publisher outlives it.
  GridOutput(const Settings& settings, const core::Camera& camera, Publisher& publisher);

  // The depth image of a frame; 32-bit float, metres, 0: unknown.
  void take_frame(double stamp_s, const cv::Mat& depth_m);
  void take_event(const Event& event);
  // `header` is that of the grid.
  void make_if_due(const messages::Header& header, const std::shared_ptr<const Map>& map);
  // The next one does not wait for its time.
  void hurry() { told_s_.reset(); }
  // The session is a new one.
  void clear();

  // Why the last map gave no grid; empty: it gave one.
  std::string why_none() const { return thread_.why_none(); }

 private:
  KeyframeDepths depths_;
  double period_s_;
  std::optional<double> told_s_;
  std::uint64_t version_told_ = 0;
  GridThread thread_;  // makes what waits before it ends
};

}  // namespace samewhere::node
