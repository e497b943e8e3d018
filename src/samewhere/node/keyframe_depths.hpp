#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include <samewhere/core/result.hpp>
#include <samewhere/core/rig.hpp>
#include <samewhere/dense/config.hpp>
#include <samewhere/dense/view.hpp>
#include <samewhere/event.hpp>
#include <samewhere/map.hpp>
#include <samewhere/messages/messages.hpp>

namespace samewhere::node {

// What a keyframe saw in depth, a point per voxel, in the axes of its camera.
struct KeyframeDepth {
  std::uint64_t keyframe = 0;  // id
  std::vector<Eigen::Vector3f> points_in_camera;
};
using SharedDepths = std::vector<std::shared_ptr<const KeyframeDepth>>;

// Collects the depth of the keyframes of a session. Holds at most dense.max_scan_points points:
// above, every other keyframe is left out.
class KeyframeDepths {
 public:
  KeyframeDepths(const dense::Config& config, const core::Camera& camera);

  // The depth image of a frame; 32-bit float, metres, 0: unknown. The last second of them is kept.
  void take_frame(double stamp_s, cv::Mat depth_m);
  void take_keyframe(const KeyframeInserted& inserted);
  // The map is a new one.
  void clear();
  const SharedDepths& all() const { return depths_; }

 private:
  struct FrameDepth {
    double stamp_s = 0.0;
    cv::Mat depth_m;
  };
  void halve();

  dense::Config config_;
  core::Camera camera_;
  dense::PointReader reader_;
  std::deque<FrameDepth> frames_;
  SharedDepths depths_;
  std::size_t num_points_ = 0;
};

// The occupancy grid of the keyframes where they are in this map. Its frame has the axes of the
// map; its header is not set. Without a floor: why.
Result<messages::OccupancyGrid, std::string> grid_of(const SharedDepths& depths, const Map& map,
                                                     const dense::Config& config);

}  // namespace samewhere::node
