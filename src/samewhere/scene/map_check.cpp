#include <algorithm>
#include <set>
#include <vector>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/scene/map_check.hpp>
#include <samewhere/scene/map_tables.hpp>
#include <samewhere/scene/observations.hpp>

namespace samewhere::scene {
namespace {

class MapCheck {
 public:
  MapCheck(const MapVersion& map, const std::string& where) : map_(map), where_(where) {}

  void run() {
    for (std::size_t i = 0; i < map_.keyframes.size(); ++i) check_keyframe(map_.keyframes[i], i);
    for (std::size_t i = 0; i < map_.landmarks.size(); ++i) check_landmark(map_.landmarks[i], i);
    part_ = "the map";
    expect(num_shown_ == num_observed_, "shows a landmark at a feature that does not see it");
    check_loops(map_.loops, "loop");
    check_loops(map_.suspended_loops, kSuspendedLoop);
    for (const LoopEdge& loop : map_.loops)
      expect(is_live(map_.at(loop.query)) && is_live(map_.at(loop.match)),
             "joins a keyframe that is culled");
    check_merges();
  }

 private:
  // An id of another session is the position of nothing.
  bool has(core::KeyframeId id) const { return id.value() < map_.keyframes.size(); }
  bool has(core::LandmarkId id) const { return id.value() < map_.landmarks.size(); }

  void expect(bool condition, const char* complaint) const {
    if (!condition)
      throw core::InputError(fmt::format("{}: {} is damaged: it {}", where_, part_, complaint));
  }

  void check_loops(const std::vector<LoopEdge>& loops, const char* name) {
    for (std::size_t i = 0; i < loops.size(); ++i) {
      part_ = fmt::format("{} {}", name, i);
      expect(has(loops[i].query) && has(loops[i].match), "names a keyframe that is not there");
      expect(loops[i].query != loops[i].match, "joins a keyframe to itself");
    }
  }

  void check_keyframe(const Keyframe& keyframe, std::size_t position) {
    part_ = fmt::format("keyframe {}", position);
    expect(keyframe.id.value() == position, "has another number");
    expect(frames_.insert(keyframe.view.frame).second, "is of a frame that another one is of");
    expect(static_cast<int>(keyframe.slots.size()) == keyframe.view.features->size(),
           "has another number of slots than of features");
    for (const core::LandmarkId id : keyframe.slots) {
      if (!id.is_valid()) continue;
      ++num_shown_;
      expect(has(id), "shows a landmark that is not there");
    }
    // so that no ring of parents comes about
    expect(!keyframe.odometry || keyframe.odometry->parent.value() < position,
           "was tracked from a keyframe that is not older");
    expect(keyframe.odometry || is_live(keyframe), "is culled and hangs on nothing");
  }

  void check_landmark(const Landmark& landmark, std::size_t position) {
    part_ = fmt::format("landmark {}", position);
    expect(landmark.id.value() == position, "has another number");
    expect(has(landmark.anchor), "hangs on a keyframe that is not there");
    expect(!landmark.merged_into.is_valid() || has(landmark.merged_into),
           "was merged into a landmark that is not there");
    seen_by_.clear();
    for (const Observation& observation : landmark.observations) {
      expect(has(observation.keyframe), "is seen by a keyframe that is not there");
      const auto num_slots = static_cast<int>(map_.at(observation.keyframe).slots.size());
      expect(observation.slot >= 0 && observation.slot < num_slots,
             "is seen by a feature that is not there");
      seen_by_.push_back(observation.keyframe);
    }
    std::sort(seen_by_.begin(), seen_by_.end());
    expect(std::adjacent_find(seen_by_.begin(), seen_by_.end()) == seen_by_.end(),
           "is seen twice by a keyframe");
    if (is_live(landmark)) check_shown(landmark);
  }

  // What it is seen by shows it, and nothing else does: see num_shown_.
  void check_shown(const Landmark& landmark) {
    for (const Observation& observation : landmark.observations)
      expect(is_live(map_.at(observation.keyframe)) && shown_at(map_, observation) == landmark.id,
             "is seen by a feature that shows another");
    num_observed_ += landmark.observations.size();
  }

  // In the order they were made, so that no ring of merges comes about: what was merged is part of
  // no later merge.
  void check_merges() {
    std::vector<bool> is_merged(map_.landmarks.size(), false);
    for (std::size_t i = 0; i < map_.merges.size(); ++i) {
      const Merge& made = map_.merges[i];
      part_ = fmt::format("merge {}", i);
      expect(has(made.from) && has(made.to), "names a landmark that is not there");
      expect(made.from != made.to, "is of a landmark with itself");
      expect(!is_merged[made.from.index()] && !is_merged[made.to.index()],
             "is of a landmark that was merged before");
      expect(map_.at(made.from).merged_into == made.to, "is not what its landmark says");
      is_merged[made.from.index()] = true;
    }
    for (std::size_t i = 0; i < map_.landmarks.size(); ++i) {
      part_ = fmt::format("landmark {}", i);
      expect(map_.landmarks[i].merged_into.is_valid() == is_merged[i],
             "was merged, and no merge says so");
    }
  }

  const MapVersion& map_;
  const std::string& where_;
  std::string part_;
  std::set<core::FrameId> frames_;
  std::size_t num_shown_ = 0;     // slots that show a landmark
  std::size_t num_observed_ = 0;  // observations of live landmarks, each at a slot of its own
  std::vector<core::KeyframeId> seen_by_;  // by one landmark, reused
};

}  // namespace

void check_map(const MapVersion& map, const std::string& where) { MapCheck(map, where).run(); }

void check_extras(const StoredMap& stored, const std::string& where) {
  const auto expect = [&](bool condition, const char* complaint) {
    if (!condition) throw core::InputError(fmt::format("{}: is damaged: {}", where, complaint));
  };
  const MapExtras& extras = stored.extras;
  for (const core::FramePose& frame : extras.frames)
    expect(!frame.is_measured || frame.reference_keyframe.value() < stored.map.keyframes.size(),
           "a frame was seen from a keyframe that is not there");
  for (const core::Descriptor& descriptor : extras.descriptors) {
    const core::Descriptor& first = extras.descriptors.front();
    expect(descriptor.unit.size() == first.unit.size() &&
               descriptor.describer_checksum == first.describer_checksum,
           "its descriptors are of several describers");
  }
}

}  // namespace samewhere::scene
