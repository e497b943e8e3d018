#include <algorithm>
#include <utility>

#include <samewhere/pipeline/passing_things.hpp>

namespace samewhere::pipeline {

namespace {

// A walking person has moved by a body width after a quarter of a second, and left after one.
constexpr double kInterval_s = 0.25;
constexpr std::size_t kNumSeen = 4;
constexpr double kOldest_s = 1.05;  // four intervals, and what frames come late

}  // namespace

void PassingThings::see(const core::Frame& frame, const core::FramePose& pose) {
  if (!frame.depth_m) return;
  if (!seen_.empty() && frame.stamp_s < seen_.back().pose.stamp_s + kInterval_s) return;
  if (seen_.size() == kNumSeen) seen_.pop_front();
  seen_.push_back({pose, frame.rig->body_from_camera[0],
                   track::NearestSurface(*frame.depth_m, frame.rig->cameras[0], config_)});
}

std::vector<int> PassingThings::shown_in(const features::View& view, const core::FramePose& pose,
                                         const scene::MapVersion& map) const {
  const core::Rigid3 world_from_camera =
      world_from_frame(map, pose) * view.rig->body_from_camera[0];
  std::vector<std::pair<const track::NearestSurface*, core::Rigid3>> seen_from_camera;
  for (const Seen& seen : seen_) {
    if (seen.pose.stamp_s < view.stamp_s - kOldest_s) continue;
    seen_from_camera.emplace_back(
        &seen.surface,
        inverse(world_from_frame(map, seen.pose) * seen.body_from_camera) * world_from_camera);
  }
  std::vector<int> shown;
  for (int i = 0; i < view.features->size(); ++i) {
    const auto point = features::point_in_camera(view, i);
    if (!point) continue;
    const bool is_new = std::any_of(
        seen_from_camera.begin(), seen_from_camera.end(),
        [&](const auto& seen) { return seen.first->sees_through(seen.second * *point); });
    if (is_new) shown.push_back(i);
  }
  return shown;
}

}  // namespace samewhere::pipeline
