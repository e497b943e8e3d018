#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include <samewhere/map/cull.hpp>
#include <samewhere/map/full_bundle.hpp>
#include <samewhere/map/test_map.hpp>

namespace samewhere::map {
namespace {

using core::KeyframeId;
using scene::MapVersion;

MapVersion with_next(const MapVersion& map, const features::TestWorld& world) {
  const auto i = static_cast<int>(map.keyframes.size());
  const features::View view = features::test_view(world, i, test_walk(i));
  // as far off as the one before
  const core::Rigid3 world_from_body =
      map.keyframes.back().world_from_body * inverse(test_walk(i - 1)) * test_walk(i);
  return apply(map, add_keyframe(map, test_tracked(map, view, world_from_body, kNone)));
}

scene::Edit found_for(const MapVersion& map) {
  return full_bundle(map, window_of_all(map, {}), {});
}

TEST(FullBundle, MovesAllKeyframesBackAndSaysThatItRestsOnLoops) {
  const features::TestWorld world = features::test_world(4, 2000);
  const MapVersion map = test_map(world, 15, 0.01);
  ASSERT_GT(worst_error(map), 0.02);
  const scene::Edit edit = found_for(map);
  const MapVersion bundled = apply(map, edit);
  EXPECT_LT(worst_error(bundled), 0.006);
  EXPECT_EQ(edit.pose_changes.size(), 14U) << "all but the oldest";
  EXPECT_TRUE(edit.refinements.empty());
  ASSERT_EQ(edit.settled.size(), 14U);
  for (std::size_t i = 1; i < 15; ++i) {
    const scene::Keyframe& keyframe = bundled.keyframes[i];
    EXPECT_EQ(parent_from_keyframe(keyframe).matrix(),
              parent_from_keyframe(map.keyframes[i]).matrix())
        << "what is known without loops";
    const core::Rigid3 step =
        inverse(bundled.at(keyframe.odometry->parent).world_from_body) * keyframe.world_from_body;
    EXPECT_LT(core::log_r3so3(inverse(step) * settled_parent_from_keyframe(keyframe)).norm(), 1e-9);
  }
}

TEST(FullBundle, EachKeyframeHasAboutAsManyObservationsAsItMay) {
  const MapVersion map = test_map(features::test_world(4, 2000), 15);
  const BundleWindow window = window_of_all(map, {.full_bundle_observations = 40});
  ASSERT_EQ(window.fixed, std::vector{KeyframeId(0)});
  ASSERT_EQ(window.free.size(), 14U);
  std::vector<int> num_seen(15, 0);
  for (const auto& id : window.landmarks)
    for (const auto& o : map.at(id).observations) ++num_seen[o.keyframe.index()];
  EXPECT_GE(*std::min_element(num_seen.begin(), num_seen.end()), 30);
  const int sum = num_observations(map, window);
  EXPECT_LT(sum, 2 * 15 * 40);
  EXPECT_TRUE(
      window_of_all(map, {.full_bundle_observations = 40, .full_bundle_max_observations = sum - 1})
          .free.empty());
  EXPECT_FALSE(
      window_of_all(map, {.full_bundle_observations = 40, .full_bundle_max_observations = sum})
          .free.empty());
}

TEST(FullBundle, ALaterKeyframeMovesWithItsAncestors) {
  const features::TestWorld world = features::test_world(4, 2000);
  const MapVersion then = test_map(world, 12, 0.01);
  const scene::Edit found = found_for(then);
  MapVersion now = then;
  for (int i = 0; i < 3; ++i) now = with_next(now, world);
  now = apply(now, scene::Edit{.culled_landmarks = {found.landmark_changes[0].landmark},
                               .culled_keyframes = {KeyframeId(5)}});
  const MapVersion bundled = apply(now, carried_over(then, now, found));
  ASSERT_GT(worst_error(now), 0.02);
  EXPECT_LT(worst_error(bundled), 0.012);
  for (std::size_t i = 12; i < 15; ++i) {
    const auto step = [&](const MapVersion& map) {
      return inverse(map.keyframes[11].world_from_body) * map.keyframes[i].world_from_body;
    };
    EXPECT_LT(core::log_r3so3(inverse(step(now)) * step(bundled)).norm(), 1e-9);
    EXPECT_FALSE(bundled.keyframes[i].settled_parent_from_keyframe) << "not in the bundle";
  }
  EXPECT_FALSE(bundled.keyframes[6].settled_parent_from_keyframe) << "its parent is another now";
  EXPECT_TRUE(bundled.keyframes[7].settled_parent_from_keyframe);
}

// A walk without depth whose lengths creep by a share per keyframe after the second. A point
// is one landmark for two to four keyframes, then it is another.
MapVersion creeping_map(const features::TestWorld& world, int num_keyframes, double creep) {
  scene::Edit edit;
  std::map<scene::OrbDescriptor, core::LandmarkId> known;
  double scale = 1.0;
  for (int i = 0; i < num_keyframes; ++i) {
    scene::Keyframe keyframe;
    keyframe.id = KeyframeId(static_cast<std::uint64_t>(i));
    keyframe.view = features::test_view(world, i, test_walk(i), 0.3, false);
    keyframe.slots.resize(static_cast<std::size_t>(keyframe.view.features->size()));
    if (i > 0) {
      core::Rigid3 step = inverse(test_walk(i - 1)) * test_walk(i);
      step.translation *= scale;
      keyframe.world_from_body = edit.keyframes.back().world_from_body * step;
      keyframe.odometry = {edit.keyframes.back().id, step};
    }
    for (int slot = 0; slot < keyframe.view.features->size(); ++slot) {
      const cv::Mat row = keyframe.view.features->descriptors.row(slot);
      scene::OrbDescriptor descriptor;
      std::copy_n(row.ptr(0), descriptor.size(), descriptor.begin());
      const auto entry = known.find(descriptor);
      const bool is_new =
          entry == known.end() ||
          edit.landmarks[entry->second.index()].anchor.index() + 2 + descriptor[0] % 3U <=
              static_cast<std::uint64_t>(i);
      if (is_new) {
        known[descriptor] = core::LandmarkId(edit.landmarks.size());
        const auto found =
            std::find(world.descriptors.begin(), world.descriptors.end(), descriptor);
        const auto point = static_cast<std::size_t>(found - world.descriptors.begin());
        scene::Landmark landmark;
        landmark.id = known[descriptor];
        landmark.anchor = keyframe.id;
        landmark.position_in_anchor = scale * (inverse(test_walk(i)) * world.points.at(point));
        edit.landmarks.push_back(landmark);
      }
      edit.sightings.push_back({known[descriptor], {keyframe.id, slot}});
    }
    edit.keyframes.push_back(keyframe);
    if (i > 0) scale *= 1.0 + creep;
  }
  return apply(MapVersion{}, edit);
}

TEST(FullBundle, WithoutDepthTwoKeyframesHoldItAndLengthsAreStretched) {
  const features::TestWorld world = features::test_world(4, 2000);
  const MapVersion map = creeping_map(world, 12, 0.02);
  const BundleWindow window = window_of_all(map, {});
  EXPECT_EQ(window.fixed, (std::vector{KeyframeId(0), KeyframeId(1)}));
  const MapVersion bundled = apply(map, full_bundle(map, window, {}));
  EXPECT_GT(worst_error(map), 0.1);
  EXPECT_LT(worst_error(bundled), 0.03);
  // a keyframe outside the window is scaled with the one it hangs on
  const std::set<core::LandmarkId> taking_part(window.landmarks.begin(), window.landmarks.end());
  const core::KeyframeId last(8);
  double ratio = 0.0;
  int num_left_out = 0;
  for (std::size_t i = 0; i < map.landmarks.size(); ++i) {
    const scene::Landmark& was = map.landmarks[i];
    if (was.anchor != last || taking_part.contains(was.id)) continue;
    ratio = bundled.at(was.id).position_in_anchor.norm() / was.position_in_anchor.norm();
    ++num_left_out;
  }
  ASSERT_GT(num_left_out, 0);
  EXPECT_NEAR(ratio, std::pow(1.02, -7.0), 0.02);
}

}  // namespace
}  // namespace samewhere::map
