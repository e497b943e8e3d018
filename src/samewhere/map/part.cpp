#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include <samewhere/map/part.hpp>
#include <samewhere/map/seen.hpp>

namespace samewhere::map {
namespace {

using core::LandmarkId;
using scene::Landmark;
using scene::MapVersion;
using scene::Observation;

bool fits(const MapVersion& map, const Landmark& landmark, const Observation& o,
          const features::Config& config) {
  const scene::Keyframe& keyframe = map.at(o.keyframe);
  const Eigen::Vector3d in_camera =
      camera_from_world(map, keyframe) * position_in_world(map, landmark);
  return is_inlier(reproject(keyframe.view, o.slot, in_camera, config));
}

bool has_loop(const MapVersion& map, core::CandidateId cause) {
  return std::any_of(map.loops.begin(), map.loops.end(),
                     [&](const scene::LoopEdge& loop) { return loop.cause == cause; });
}

// As far off as another place, not as poses that are to be bundled yet: three times the limit of
// an inlier, in pixels.
bool is_elsewhere(const MapVersion& map, const Landmark& landmark, const Observation& o,
                  const features::Config& config) {
  constexpr double kFactor = 9.0;  // of the squared error
  const scene::Keyframe& keyframe = map.at(o.keyframe);
  const auto r =
      reproject(keyframe.view, o.slot,
                camera_from_world(map, keyframe) * position_in_world(map, landmark), config);
  return r.size == 0 || r.value.squaredNorm() > kFactor * optimize::kChiSquare95[r.size];
}

// A map before places were parted, and what of it holds after.
class Parting {
 public:
  Parting(const MapVersion& before, MapVersion after, const features::Config& config)
      : before_(before), map_(std::move(after)), config_(config) {
    for (const auto& loop : before_.loops)
      if (!has_loop(map_, loop.cause)) joined_at_ = std::min(joined_at_, loop.closed_at);
  }

  std::vector<scene::Edit> edits() && {
    unmerge();
    remove_misfits();
    hand_over();
    place_anew();
    return std::move(edits_);
  }

 private:
  void take(scene::Edit edit) {
    map_ = apply(std::move(map_), edit);
    edits_.push_back(std::move(edit));
  }

  const Landmark& shown_before(LandmarkId id) const { return survivor_of(before_, id); }

  // It fitted what the landmark was part of, and does not fit the landmark now.
  bool is_misfit(const Landmark& shown, const Landmark& landmark, const Observation& o) const {
    return fits(before_, shown, o, config_) && is_elsewhere(map_, landmark, o, config_);
  }

  bool is_wrong(const scene::Merge& made) const {
    const Landmark& survivor = survivor_of(map_, made.from);
    int num_near = 0;
    int num_elsewhere = 0;
    for (const auto& o : map_.at(made.from).observations) {
      if (is_live(map_.at(o.keyframe)))
        (is_elsewhere(map_, survivor, o, config_) ? num_elsewhere : num_near) += 1;
    }
    return num_elsewhere > num_near;
  }

  void unmerge() {
    scene::Edit edit;
    for (std::size_t i = 0; i < map_.merges.size(); ++i)
      if (map_.merges[i].made_at >= joined_at_ && is_wrong(map_.merges[i]))
        edit.unmerged_landmarks.push_back(map_.merges[i].from);
    take(std::move(edit));
  }

  void remove_misfits() {
    scene::Edit edit;
    for (std::size_t i = 0; i < map_.landmarks.size(); ++i) {
      const Landmark& landmark = map_.landmarks[i];
      if (!is_live(landmark)) continue;
      for (const auto& o : landmark.observations) {
        if (!is_misfit(shown_before(landmark.id), landmark, o)) continue;
        edit.removed_observations.push_back({landmark.id, o.keyframe});
        removed_.emplace_back(landmark.id, o);
      }
    }
    take(std::move(edit));
  }

  // What was shown as one until now, by what stood for it.
  std::map<LandmarkId, std::vector<LandmarkId>> parted_landmarks() const {
    std::map<LandmarkId, std::vector<LandmarkId>> parts;
    for (std::size_t i = 0; i < map_.landmarks.size(); ++i) {
      const Landmark& landmark = map_.landmarks[i];
      if (is_live(landmark)) parts[shown_before(landmark.id).id].push_back(landmark.id);
    }
    return parts;
  }

  void hand_over() {
    const auto parts = parted_landmarks();
    std::set<std::pair<LandmarkId, core::KeyframeId>> given;
    scene::Edit edit;
    for (const auto& [landmark, o] : removed_) {
      const auto found = parts.find(shown_before(landmark).id);
      if (found == parts.end()) continue;
      for (const LandmarkId part : found->second) {
        if (part == landmark || is_seen_by(map_.at(part), o.keyframe)) continue;
        if (!fits(map_, map_.at(part), o, config_) || !given.emplace(part, o.keyframe).second)
          continue;
        edit.sightings.push_back({part, {o.keyframe, o.slot}});
        break;
      }
    }
    take(std::move(edit));
  }

  bool is_unsupported(const Landmark& landmark) const {
    return landmark.observations.size() == 1 &&
           !point_in_camera(map_.at(landmark.observations[0].keyframe).view,
                            landmark.observations[0].slot);
  }

  // Nothing where no observation has depth.
  std::optional<Eigen::Vector3d> position_by_depth(const Landmark& landmark) const {
    const core::Rigid3 anchor_from_world = inverse(world_from_body(map_, landmark.anchor));
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double weight = 0.0;
    for (const auto& o : landmark.observations) {
      const scene::Keyframe& keyframe = map_.at(o.keyframe);
      const auto point = point_in_camera(keyframe.view, o.slot);
      if (!point) continue;
      sum +=
          scene::weight_of_depth(point->z()) * (anchor_from_world * keyframe.world_from_body *
                                                (keyframe.view.rig->body_from_camera[0] * *point));
      weight += scene::weight_of_depth(point->z());
    }
    if (weight == 0.0) return std::nullopt;
    return Eigen::Vector3d(sum / weight);
  }

  std::set<LandmarkId> touched_landmarks() const {
    std::set<LandmarkId> touched;
    for (const auto& [landmark, o] : removed_) {
      touched.insert(landmark);
      for (const auto& id : map_.at(o.keyframe).slots)
        if (id.is_valid()) touched.insert(id);
    }
    return touched;
  }

  void place_anew() {
    scene::Edit edit;
    for (const LandmarkId id : touched_landmarks()) {
      const Landmark& landmark = map_.at(id);
      if (!is_live(landmark)) continue;
      if (is_unsupported(landmark)) {
        edit.culled_landmarks.push_back(id);
      } else if (const auto position = position_by_depth(landmark)) {
        edit.landmark_changes.push_back({id, *position});
      }
    }
    take(std::move(edit));
  }

  const MapVersion& before_;
  MapVersion map_;
  const features::Config& config_;
  // the number of the map in which the first of the loops was closed that are gone
  std::uint64_t joined_at_ = std::numeric_limits<std::uint64_t>::max();
  std::vector<std::pair<LandmarkId, Observation>> removed_;
  std::vector<scene::Edit> edits_;
};

}  // namespace

std::vector<scene::Edit> part_places(const MapVersion& before, const MapVersion& after,
                                     const features::Config& features) {
  return Parting(before, after, features).edits();
}

scene::TrackedView without_parted(const MapVersion& map, scene::TrackedView tracked,
                                  const features::Config& features) {
  const core::FramePose& pose = tracked.pose;
  const core::Rigid3 camera_from_world =
      inverse(world_from_frame(map, pose) * tracked.view.rig->body_from_camera[0]);
  std::erase_if(tracked.landmarks, [&](const auto& shown) {
    const auto& [feature, id] = shown;
    const Eigen::Vector3d point = position_in_world(map, survivor_of(map, id));
    return !is_inlier(reproject(tracked.view, feature, camera_from_world * point, features));
  });
  return tracked;
}

}  // namespace samewhere::map
