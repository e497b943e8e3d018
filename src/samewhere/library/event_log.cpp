#include <algorithm>
#include <utility>

#include <samewhere/library/convert.hpp>
#include <samewhere/library/event_log.hpp>
#include <samewhere/library/map_content.hpp>

namespace samewhere::library {
namespace {

bool are_same_loops(const scene::MapVersion& a, const scene::MapVersion& b) {
  return std::equal(a.loops.begin(), a.loops.end(), b.loops.begin(), b.loops.end(),
                    [](const auto& x, const auto& y) { return x.cause == y.cause; });
}

// Version of the last full bundle adjustment.
std::uint64_t settled_at(const scene::MapVersion& map) {
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i)
    number = std::max(number, map.keyframes[i].settled_at);
  return number;
}

}  // namespace

std::vector<Event> EventLog::update(const pipeline::Slam& slam) {
  const core::FramePose& newest = slam.frames().back();
  frame_ = newest.frame.index();
  stamp_s_ = newest.stamp_s;
  add_verdicts(slam.newest_rows());
  if (slam.num_reinitializations() != num_reinitializations_) add(MapDiscarded{});
  num_reinitializations_ = slam.num_reinitializations();
  if (slam.visible_map().number != before_.number) add_map_changes(slam.visible_map());
  add_tracking_changes(slam);
  return std::exchange(events_, {});
}

std::vector<Event> EventLog::finish(const pipeline::Slam& slam) {
  add_verdicts(slam.newest_rows());
  if (slam.map().number != before_.number) add_map_changes(slam.map());
  return std::exchange(events_, {});
}

void EventLog::add_verdicts(const core::Ledger& rows) {
  for (const core::LedgerRow& row : rows) add(verdict_of(row));
}

void EventLog::add_map_changes(const scene::MapVersion& map) {
  for (std::size_t i = before_.keyframes.size(); i < map.keyframes.size(); ++i) {
    const scene::Keyframe& keyframe = map.keyframes[i];
    add(KeyframeInserted{.keyframe = keyframe.id.value(),
                         .frame = key_of(keyframe.view.frame),
                         .stamp_s = keyframe.view.stamp_s,
                         .map_from_camera = map_from_camera(map, keyframe)});
  }
  if (!are_same_loops(before_, map) || settled_at(before_) != settled_at(map)) add_correction(map);
  before_ = map;
}

void EventLog::add_correction(const scene::MapVersion& map) {
  MapCorrected correction{.map_version = map.number, .moves = {}};
  for (std::size_t i = 0; i < before_.keyframes.size(); ++i) {
    const Pose old_pose = map_from_camera(before_, before_.keyframes[i]);
    const Pose new_pose = map_from_camera(map, map.keyframes[i]);
    if (old_pose.matrix() != new_pose.matrix())
      correction.moves.push_back({map.keyframes[i].id.value(), old_pose, new_pose});
  }
  add(std::move(correction));
}

void EventLog::add_tracking_changes(const pipeline::Slam& slam) {
  using enum RelocalizationStep;
  const pipeline::RelocalizationCounts& counts = slam.relocalizations();
  if (counts.num_provisional != counts_.num_provisional) add(Relocalized{kProvisional});
  if (counts.num_taken_back != counts_.num_taken_back) add(Relocalized{kTakenBack});
  counts_ = counts;
  const core::FramePose& newest = slam.frames().back();
  if (newest.is_measured && newest.status == core::FrameStatus::kResumed)
    add(Relocalized{kConfirmed});
  const bool has_pose = is_confirmed(newest);
  if (had_pose_ && !has_pose) add(TrackingLost{last_pose_s_});
  if (has_pose) last_pose_s_ = newest.stamp_s;
  had_pose_ = has_pose;
}

}  // namespace samewhere::library
