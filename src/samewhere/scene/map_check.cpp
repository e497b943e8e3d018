#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/scene/map_check.hpp>

namespace samewhere::scene {
namespace {

class MapCheck {
 public:
  MapCheck(const MapVersion& map, const std::string& where) : map_(map), where_(where) {}

  void run() {
    for (std::size_t i = 0; i < map_.keyframes.size(); ++i) check_keyframe(map_.keyframes[i], i);
    for (std::size_t i = 0; i < map_.landmarks.size(); ++i) check_landmark(map_.landmarks[i], i);
    check_loops(map_.loops, "loop");
    check_loops(map_.doubted_loops, "doubted_loop");
    for (std::size_t i = 0; i < map_.merges.size(); ++i) {
      part_ = fmt::format("merge {}", i);
      expect(has(map_.merges[i].from) && has(map_.merges[i].to),
             "names a landmark that is not there");
    }
  }

 private:
  bool has(core::KeyframeId id) const { return id.index() < map_.keyframes.size(); }
  bool has(core::LandmarkId id) const { return id.index() < map_.landmarks.size(); }

  void expect(bool condition, const char* complaint) const {
    if (!condition)
      throw core::InputError(fmt::format("{}: {} is damaged: it {}", where_, part_, complaint));
  }

  void check_loops(const std::vector<LoopEdge>& loops, const char* name) {
    for (std::size_t i = 0; i < loops.size(); ++i) {
      part_ = fmt::format("{} {}", name, i);
      expect(has(loops[i].query) && has(loops[i].match), "names a keyframe that is not there");
    }
  }

  void check_features(const features::View& view) const {
    const features::Features& f = *view.features;
    const std::size_t size = f.raw_px.size();
    expect(f.undistorted_px.size() == size && f.depth_m.size() == size &&
               f.right_x_px.size() == size && f.octave.size() == size &&
               f.angle_rad.size() == size && f.rgb.size() == size &&
               f.descriptors.rows == f.size() && (size == 0 || f.descriptors.cols == 32),
           "has lists of features of different lengths");
    expect(view.rig->cameras.size() == view.rig->body_from_camera.size(),
           "has a rig with another number of cameras than of their poses");
  }

  void check_keyframe(const Keyframe& keyframe, std::size_t position) {
    part_ = fmt::format("keyframe {}", position);
    expect(keyframe.id.index() == position, "has another number");
    check_features(keyframe.view);
    expect(static_cast<int>(keyframe.slots.size()) == keyframe.view.features->size(),
           "has another number of slots than of features");
    for (const core::LandmarkId id : keyframe.slots)
      expect(!id.is_valid() || has(id), "shows a landmark that is not there");
    expect(!keyframe.odometry || keyframe.odometry->parent.index() < position,
           "was tracked from a keyframe that is not older");
    expect(keyframe.odometry || is_live(keyframe), "is culled and hangs on nothing");
  }

  void check_landmark(const Landmark& landmark, std::size_t position) {
    part_ = fmt::format("landmark {}", position);
    expect(landmark.id.index() == position, "has another number");
    expect(has(landmark.anchor), "hangs on a keyframe that is not there");
    expect(!landmark.merged_into.is_valid() || has(landmark.merged_into),
           "was merged into a landmark that is not there");
    for (const Observation& observation : landmark.observations) {
      expect(has(observation.keyframe), "is seen by a keyframe that is not there");
      const auto num_slots = static_cast<int>(map_.at(observation.keyframe).slots.size());
      expect(observation.slot >= 0 && observation.slot < num_slots,
             "is seen by a feature that is not there");
    }
  }

  const MapVersion& map_;
  const std::string& where_;
  std::string part_;
};

}  // namespace

void check_map(const MapVersion& map, const std::string& where) { MapCheck(map, where).run(); }

}  // namespace samewhere::scene
