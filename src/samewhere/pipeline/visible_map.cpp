#include <samewhere/map/mapper.hpp>
#include <samewhere/pipeline/visible_map.hpp>
#include <samewhere/track/drift_model.hpp>

namespace samewhere::pipeline {

void VisibleMap::set_reference(core::KeyframeId reference) {
  local_map_ = map::local_map(version_, reference, config_);
}

core::Rigid3 VisibleMap::world_from(const core::FramePose& pose) const {
  return world_from_frame(version_, pose);
}

core::Rigid3 VisibleMap::reference_from(const core::FramePose& pose) const {
  return inverse(world_from_body(version_, local_map_.reference)) * world_from(pose);
}

core::FramePose VisibleMap::relative_to(core::KeyframeId reference, core::FramePose pose) const {
  const core::Rigid3 from_old = inverse(world_from_body(version_, reference)) *
                                world_from_body(version_, pose.reference_keyframe);
  pose.information = track::seen_from(from_old, pose.information);
  pose.reference_from_frame = inverse(world_from_body(version_, reference)) * world_from(pose);
  pose.reference_keyframe = reference;
  pose.log_scale = version_.at(reference).log_scale;
  return pose;
}

core::FramePose VisibleMap::by_odometry(const core::FramePose& pose,
                                        std::uint64_t tracked_since_keyframe) {
  const core::KeyframeId newest = version_.keyframes.back().id;
  const core::KeyframeId reference = holder_of(version_, pose.reference_keyframe).keyframe;
  const bool has_odometry = newest.index() >= tracked_since_keyframe;
  if (!has_odometry || newest == reference || version_.loops.empty()) return pose;
  const Chain chain{version_.number, newest, reference};
  if (!last_chain_ || last_chain_->first != chain)
    last_chain_ = {chain, shortest_path_uses_loop(version_, newest, reference)};
  return last_chain_->second ? relative_to(newest, pose) : pose;
}

scene::TrackedView VisibleMap::tracked_view(const features::View& view,
                                            const track::Track& track) const {
  scene::TrackedView tracked{view, track.pose, {}, {}};
  tracked.pose.log_scale = version_.at(track.pose.reference_keyframe).log_scale;
  for (const auto& match : track.matches) {
    tracked.landmarks.emplace_back(match.second,
                                   local_map_.landmarks[static_cast<std::size_t>(match.first)]);
  }
  return tracked;
}

}  // namespace samewhere::pipeline
