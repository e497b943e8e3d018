#include <algorithm>
#include <map>
#include <utility>
#include <variant>

#include <samewhere/dense/grid_message.hpp>
#include <samewhere/dense/scans.hpp>
#include <samewhere/library/convert.hpp>
#include <samewhere/node/keyframe_depths.hpp>

namespace samewhere::node {
namespace {

// A keyframe is told of after a few frames.
constexpr std::size_t kMaxFrames = 30;

}  // namespace

KeyframeDepths::KeyframeDepths(const dense::Config& config, const core::Camera& camera)
    : config_(config), camera_(camera), reader_(config) {}

void KeyframeDepths::take_frame(double stamp_s, cv::Mat depth_m) {
  if (!std::holds_alternative<core::PinholeRadtan>(camera_)) return;
  frames_.push_back({stamp_s, std::move(depth_m)});
  if (frames_.size() > kMaxFrames) frames_.pop_front();
}

void KeyframeDepths::take_keyframe(const KeyframeInserted& inserted) {
  const auto frame = std::find_if(frames_.begin(), frames_.end(), [&](const FrameDepth& f) {
    return f.stamp_s == inserted.stamp_s;
  });
  if (frame == frames_.end()) return;
  depths_.push_back(std::make_shared<const KeyframeDepth>(KeyframeDepth{
      inserted.keyframe,
      dense::thinned(reader_.points_in_camera(camera_, frame->depth_m), config_.grid_cell_m)}));
  num_points_ += depths_.back()->points_in_camera.size();
  while (num_points_ > static_cast<std::size_t>(config_.max_scan_points) && depths_.size() > 1)
    halve();
}

void KeyframeDepths::halve() {
  SharedDepths kept;
  num_points_ = 0;
  for (std::size_t i = (depths_.size() - 1) % 2; i < depths_.size(); i += 2) {
    num_points_ += depths_[i]->points_in_camera.size();
    kept.push_back(std::move(depths_[i]));
  }
  depths_ = std::move(kept);
}

void KeyframeDepths::clear() {
  frames_.clear();
  depths_.clear();
  num_points_ = 0;
}

Result<messages::OccupancyGrid, std::string> grid_of(const SharedDepths& depths, const Map& map,
                                                     const dense::Config& config) {
  std::map<std::uint64_t, Pose> poses;
  for (const Map::Keyframe& keyframe : map.keyframes())
    poses.emplace(keyframe.id, keyframe.map_from_camera);
  std::vector<dense::Scan> scans;
  core::Trajectory cameras;
  for (const auto& depth : depths) {
    const auto pose = poses.find(depth->keyframe);
    if (pose == poses.end()) continue;
    const Eigen::Isometry3f map_from_camera = pose->second.cast<float>();
    dense::Scan scan{map_from_camera.translation(), {}};
    scan.points_in_world.reserve(depth->points_in_camera.size());
    for (const Eigen::Vector3f& point : depth->points_in_camera)
      scan.points_in_world.push_back(map_from_camera * point);
    scans.push_back(std::move(scan));
    cameras.push_back({0.0, library::rigid_of(pose->second)});
  }
  if (scans.empty()) return refuse(std::string("no keyframe has depth"));
  const auto grid = dense::find_grid(scans, cameras, Eigen::Vector3d::UnitX(), config, 0);
  if (!grid) return refuse(grid.error());
  return dense::grid_message(*grid, core::Rigid3{});
}

}  // namespace samewhere::node
