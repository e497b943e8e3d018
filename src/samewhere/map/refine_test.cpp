#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include <samewhere/map/cull.hpp>
#include <samewhere/map/fuse.hpp>
#include <samewhere/map/local_bundle.hpp>
#include <samewhere/map/seen.hpp>
#include <samewhere/map/test_map.hpp>
#include <samewhere/map/triangulate.hpp>

namespace samewhere::map {
namespace {

const scene::Keyframe& newest(const scene::MapVersion& map) { return map.keyframes.back(); }

// Distance of each live landmark to the point of the world that has its descriptor.
std::vector<double> errors_m(const scene::MapVersion& map, const features::TestWorld& world,
                             std::size_t first) {
  std::vector<double> errors;
  for (std::size_t i = first; i < map.landmarks.size(); ++i) {
    const scene::Landmark& landmark = map.landmarks[i];
    const auto found =
        std::find(world.descriptors.begin(), world.descriptors.end(), landmark.descriptor);
    const auto point = static_cast<std::size_t>(found - world.descriptors.begin());
    if (is_live(landmark))
      errors.push_back((position_in_world(map, landmark) - world.points.at(point)).norm());
  }
  std::sort(errors.begin(), errors.end());
  return errors;
}

// Two keyframes without depth that share the first 60 points that both see, and no others.
scene::MapVersion without_depth(const features::TestWorld& world) {
  scene::MapVersion map = test_map(world, 1);
  scene::Edit edit;
  for (std::uint64_t i = 0; i < 2; ++i) {
    scene::Keyframe keyframe;
    keyframe.id = core::KeyframeId(i);
    keyframe.world_from_body = test_walk(4 * static_cast<int>(i));
    keyframe.view =
        features::test_view(world, 10 + static_cast<int>(i), keyframe.world_from_body, 0.3, false);
    keyframe.slots.resize(static_cast<std::size_t>(keyframe.view.features->size()));
    edit.keyframes.push_back(keyframe);
  }
  auto matches = features::match_pair(edit.keyframes[0].view.features->descriptors,
                                      edit.keyframes[1].view.features->descriptors, {});
  matches.resize(60);
  for (const auto& match : matches) {
    scene::Landmark landmark;
    landmark.id = core::LandmarkId(edit.landmarks.size());
    landmark.anchor = core::KeyframeId(0);
    landmark.position_in_anchor = {0.0, 0.0, 3.0};
    edit.landmarks.push_back(landmark);
    edit.sightings.push_back({landmark.id, {core::KeyframeId(0), match.first}});
    edit.sightings.push_back({landmark.id, {core::KeyframeId(1), match.second}});
  }
  return apply(scene::MapVersion{}, edit);
}

TEST(Triangulate, PointsWithoutDepthComeOutOfTwoViews) {
  const features::TestWorld world = features::test_world(3);
  const scene::MapVersion map = without_depth(world);
  const scene::MapVersion grown =
      apply(map, triangulate_landmarks(map, core::KeyframeId(1), {}, {}));
  const auto errors = errors_m(grown, world, 60);
  ASSERT_GT(errors.size(), 200U);
  EXPECT_LT(errors[errors.size() / 2], 0.03);
  EXPECT_LT(errors[errors.size() * 95 / 100], 0.3);
  for (std::size_t i = 60; i < grown.landmarks.size(); ++i) {
    EXPECT_EQ(grown.landmarks[i].observations.size(), 2U);
    EXPECT_GT(grown.landmarks[i].range_m, 1.0);
  }
}

TEST(Triangulate, RaysThatAreNearlyParallelMakeNoPoint) {
  const scene::MapVersion map = without_depth(features::test_world(3));
  EXPECT_TRUE(triangulate_landmarks(map, core::KeyframeId(1), {.min_parallax_rad = 0.9}, {})
                  .landmarks.empty());
}

TEST(Fuse, WhatTrackingOverlookedBecomesOneLandmarkAgain) {
  const features::TestWorld world = features::test_world(3);
  scene::MapVersion map = test_map(world, 2);
  const features::View view = features::test_view(world, 2, test_walk(2));
  const auto is_odd = [](core::LandmarkId id) { return id.index() % 2 == 1; };
  map = apply(map, add_keyframe(map, test_tracked(map, view, test_walk(2), is_odd)));
  const std::size_t num_before = num_live(map.landmarks);
  for (const auto& edit : fuse_around(map, newest(map).id, {}, {})) map = apply(map, edit);
  std::set<scene::OrbDescriptor> different;
  for (std::size_t i = 0; i < map.landmarks.size(); ++i)
    different.insert(map.landmarks[i].descriptor);
  EXPECT_GT(num_before, different.size() + 100) << "doubled";
  EXPECT_LT(static_cast<double>(num_live(map.landmarks)),
            1.03 * static_cast<double>(different.size()));
  for (std::size_t i = 0; i < map.landmarks.size(); ++i) {
    std::set<core::KeyframeId> seen_by;
    for (const auto& o : map.landmarks[i].observations) {
      EXPECT_TRUE(seen_by.insert(o.keyframe).second) << "landmark " << i << " twice in a picture";
      if (is_live(map.landmarks[i])) {
        EXPECT_EQ(map.at(o.keyframe).slots[static_cast<std::size_t>(o.slot)], map.landmarks[i].id);
      }
    }
  }
}

constexpr auto kAll = [](core::LandmarkId) { return true; };

// Two keyframes, and a third by which tracking knew nothing of what they show.
scene::MapVersion forgotten(const features::TestWorld& world, const core::Rigid3& error) {
  const scene::MapVersion map = test_map(world, 2);
  const features::View view = features::test_view(world, 2, test_walk(2));
  return apply(map, add_keyframe(map, test_tracked(map, view, test_walk(2) * error, kAll)));
}

TEST(Fuse, WhatALoopJoinsBearsItsCauseAndGoesIntoWhatWasSeenMoreOften) {
  const features::TestWorld world = features::test_world(3);
  const scene::MapVersion map = forgotten(world, core::Rigid3{});
  const scene::LoopEdge loop{
      .query = newest(map).id, .match = core::KeyframeId(1), .cause = core::CandidateId(7)};
  std::size_t num_merges = 0;
  for (const scene::Edit& edit : fuse_across(map, loop, {}, {})) {
    num_merges += edit.merges.size();
    for (const scene::Merge& merge : edit.merges) {
      EXPECT_EQ(merge.cause, loop.cause);
      EXPECT_EQ(map.at(merge.from).descriptor, map.at(merge.to).descriptor) << "one point";
      EXPECT_EQ(map.at(merge.from).anchor, loop.query) << "the younger, or seen less often";
    }
    for (const scene::Sighting& sighting : edit.sightings)
      EXPECT_EQ(sighting.observation.cause, loop.cause);
  }
  EXPECT_GT(num_merges, 300U);
}

TEST(Fuse, WhatDoesNotFitIsLeftApart) {
  const features::TestWorld world = features::test_world(3);
  // four pixels: inside the radius in which it is looked for
  const scene::MapVersion map = forgotten(world, core::Rigid3{core::exp_so3({0.0, 0.008, 0.0})});
  Config config;
  config.fuse_radius_px = 8.0;
  std::vector<core::LandmarkId> old;
  for (std::uint64_t i = 0; i < 300; ++i) old.emplace_back(i);
  const scene::Edit edit = fuse_into(map, newest(map).id, old, config, {});
  EXPECT_LT(edit.merges.size() + edit.sightings.size(), 10U);
}

TEST(Fuse, WhatOnePictureShowsTwiceIsTwoThings) {
  const features::TestWorld world = features::test_world(3);
  const scene::MapVersion map = test_map(world, 1);
  scene::TrackedView tracked =
      test_tracked(map, features::test_view(world, 1, test_walk(1)), test_walk(1), kNone);
  // the feature of one landmark shows another, and both are in the first picture
  const core::LandmarkId one = tracked.landmarks.at(0).second;
  tracked.landmarks[0].second = tracked.landmarks.at(1).second;
  tracked.landmarks.erase(tracked.landmarks.begin() + 1);
  const scene::MapVersion both = apply(map, add_keyframe(map, tracked));
  const scene::Edit edit = fuse_into(both, newest(both).id, {one}, {}, {});
  EXPECT_TRUE(edit.merges.empty());
  EXPECT_TRUE(edit.sightings.empty()) << "the feature is taken";
}

// One that the first keyframe shows in the middle of its picture.
const scene::Landmark& straight_ahead(const scene::MapVersion& map) {
  std::size_t best = 0;
  const auto aside = [&](std::size_t i) {
    return map.landmarks[i].position_in_anchor.head<2>().norm() /
           map.landmarks[i].position_in_anchor.z();
  };
  for (std::size_t i = 1; i < map.landmarks.size(); ++i) best = aside(i) < aside(best) ? i : best;
  return map.landmarks[best];
}

TEST(ExpectedAt, IsWhereTheKeyframeShowsIt) {
  const scene::MapVersion map = test_map(features::test_world(3), 1);
  const scene::Landmark& landmark = straight_ahead(map);
  const auto seen = expected_at(map, map.keyframes[0], landmark, {});
  ASSERT_TRUE(seen);
  const auto slot = static_cast<std::size_t>(landmark.observations.at(0).slot);
  const Eigen::Vector2d shown = map.keyframes[0].view.features->undistorted_px[slot].cast<double>();
  EXPECT_LT((seen->pixel - shown).norm(), 0.01);
}

TEST(ExpectedAt, IsNothingBehindFromTheOtherSideOrFromTooFar) {
  const scene::MapVersion map = test_map(features::test_world(3), 1);
  const scene::Landmark& landmark = straight_ahead(map);
  const double range_m = landmark.position_in_anchor.z();
  // by a keyframe there, turned so much about the vertical
  const auto is_expected = [&](double forward_m, double turn_rad) {
    scene::Edit edit;
    edit.keyframes.push_back(map.keyframes[0]);
    edit.keyframes[0].id = core::KeyframeId(1);
    edit.keyframes[0].world_from_body = {core::exp_so3({0.0, turn_rad, 0.0}),
                                         {0.0, 0.0, forward_m}};
    std::fill(edit.keyframes[0].slots.begin(), edit.keyframes[0].slots.end(), core::LandmarkId());
    const scene::MapVersion both = apply(map, edit);
    return expected_at(both, newest(both), landmark, {}).has_value();
  };
  const double about_rad = 3.14159265;
  EXPECT_TRUE(is_expected(-0.2 * range_m, 0.0));
  EXPECT_FALSE(is_expected(0.0, about_rad)) << "behind";
  EXPECT_FALSE(is_expected(2.0 * range_m, about_rad)) << "from the other side";
  EXPECT_FALSE(is_expected(-9.0 * range_m, 0.0)) << "too far";
  EXPECT_FALSE(is_expected(0.9 * range_m, 0.0)) << "too near for its level";
}

TEST(LocalBundle, MovesDisturbedKeyframesBackAndLeavesOdometryAlone) {
  const features::TestWorld world = features::test_world(4, 2000);
  const scene::MapVersion map = test_map(world, 6, 0.01);
  const scene::Edit edit = bundle_around(map, newest(map).id, {});
  const scene::MapVersion bundled = apply(map, edit);
  EXPECT_GT(worst_error(map), 0.02);
  EXPECT_LT(worst_error(bundled), 0.006);
  EXPECT_EQ(bundled.keyframes[0].world_from_body.matrix(), core::Rigid3{}.matrix()) << "the gauge";
  EXPECT_EQ(edit.refinements.size(), 5U);
  for (std::size_t i = 1; i < 6; ++i) {
    EXPECT_EQ(bundled.keyframes[i].odometry->parent_from_keyframe.matrix(),
              map.keyframes[i].odometry->parent_from_keyframe.matrix());
    const core::Rigid3 step =
        inverse(bundled.keyframes[i - 1].world_from_body) * bundled.keyframes[i].world_from_body;
    EXPECT_LT(core::log_r3so3(inverse(step) * parent_from_keyframe(bundled.keyframes[i])).norm(),
              1e-9);
  }
  const auto before = errors_m(map, world, 0);
  const auto after = errors_m(bundled, world, 0);
  EXPECT_LT(after[after.size() / 2], before[before.size() / 2]);
}

TEST(LocalBundle, TheWindowKeepsItsLimits) {
  const scene::MapVersion map = test_map(features::test_world(4, 2000), 9);
  const Config config{
      .bundle_keyframes = 3, .bundle_fixed_keyframes = 2, .bundle_observations = 500};
  const BundleWindow window = window_around(map, newest(map).id, config);
  EXPECT_EQ(window.free,
            (std::vector{core::KeyframeId(6), core::KeyframeId(7), core::KeyframeId(8)}));
  EXPECT_EQ(window.fixed.size(), 2U);
  std::size_t num_observations = 0;
  for (const auto& id : window.landmarks) num_observations += map.at(id).observations.size();
  EXPECT_LE(num_observations, 500U);
  EXPECT_GT(num_observations, 400U);
}

TEST(LocalBundle, AKeyframeAloneStaysWhereItIs) {
  const scene::MapVersion map = test_map(features::test_world(4, 500), 1);
  EXPECT_TRUE(bundle_around(map, core::KeyframeId(0), {}).pose_changes.empty());
}

// Landmarks of keyframe 1 whose id is a multiple of five.
bool is_of_second_fifth(const scene::MapVersion& map, core::LandmarkId id) {
  return map.at(id).anchor == core::KeyframeId(1) && id.index() % 5 == 0;
}

TEST(Cull, ALandmarkThatIsNeverMatchedAgainIsCulled) {
  const features::TestWorld world = features::test_world(5, 2000);
  scene::MapVersion map = test_map(world, 2);
  const auto is_lost = [&](core::LandmarkId id) { return is_of_second_fifth(map, id); };
  for (int i = 2; i < 5; ++i) {
    const features::View view = features::test_view(world, i, test_walk(i));
    map = apply(map, add_keyframe(map, test_tracked(map, view, test_walk(i), is_lost)));
  }
  const scene::Edit edit = cull_around(map, newest(map).id, {}, {});
  EXPECT_GT(edit.culled_landmarks.size(), 2U);
  for (const auto& id : edit.culled_landmarks) EXPECT_TRUE(is_lost(id)) << "landmark " << id;
}

TEST(Cull, WhatIsOutOfSightStaysUntilItIsForgottenUnlessTwoHaveSeenIt) {
  const features::TestWorld world = features::test_world(5, 2000);
  scene::MapVersion map = test_map(world, 2);
  const auto is_lost = [&](core::LandmarkId id) { return is_of_second_fifth(map, id); };
  for (int i = 2; i < 5; ++i) {
    const core::Rigid3 back{core::exp_so3({0.0, 3.1, 0.0}), {0.0, 0.0, 0.0}};
    const core::Rigid3 pose = i == 2 ? test_walk(2) : back;  // then the camera turns round
    const features::View view = features::test_view(world, i, pose);
    map = apply(map, add_keyframe(map, test_tracked(map, view, pose, is_lost)));
  }
  EXPECT_TRUE(cull_around(map, newest(map).id, {}, {}).culled_landmarks.empty());
  const Config soon{.cull_after_keyframes = 2, .cull_unmatched_after_keyframes = 3};
  const scene::Edit edit = cull_around(map, newest(map).id, soon, {});
  const std::set<core::LandmarkId> gone(edit.culled_landmarks.begin(), edit.culled_landmarks.end());
  int num_seen_by_two = 0;
  for (const auto& id : map.keyframes[1].slots) {
    if (!id.is_valid() || map.at(id).anchor != core::KeyframeId(1)) continue;
    const bool is_seen_by_two = map.at(id).observations.size() > 1;
    num_seen_by_two += is_seen_by_two ? 1 : 0;
    EXPECT_EQ(gone.contains(id), !is_seen_by_two) << "landmark " << id;
  }
  EXPECT_GT(num_seen_by_two, 2);
  EXPECT_FALSE(gone.empty());
}

// Keyframes and landmarks of a camera that sways before one wall; in each view a third of what is
// seen are things that are never seen again.
std::pair<std::size_t, std::size_t> size_after_swaying(int num_views, const Config& config) {
  const features::TestWorld wall = features::test_world(6, 1500);
  scene::MapVersion map;
  for (int i = 0; i < num_views; ++i) {
    features::TestWorld world = features::test_world(100 + static_cast<std::uint64_t>(i), 750);
    world.points.insert(world.points.begin(), wall.points.begin(), wall.points.end());
    world.descriptors.insert(world.descriptors.begin(), wall.descriptors.begin(),
                             wall.descriptors.end());
    const core::Rigid3 pose = test_walk(i % 4);
    const features::View view = features::test_view(world, i, pose);
    if (i == 0) {
      map = apply(map, start_map(map, view, pose));
      continue;
    }
    map = apply(map, add_keyframe(map, test_tracked(map, view, pose, kNone)));
    for (const auto& edit : fuse_around(map, newest(map).id, config, {})) map = apply(map, edit);
    map = apply(map, cull_around(map, newest(map).id, config, {}));
  }
  return {num_live(map.keyframes), num_live(map.landmarks)};
}

// Nothing is blamed for not being found: that would hide what forgetting does.
TEST(Cull, TheMapOfAStationaryCameraHardlyGrows) {
  const Config config{.min_found_ratio = 0.0};
  const auto [num_keyframes, num_landmarks] = size_after_swaying(20, config);
  const auto [num_later, num_landmarks_later] = size_after_swaying(60, config);
  EXPECT_LE(num_later, num_keyframes + 2);
  EXPECT_LE(num_landmarks_later, num_landmarks + num_landmarks / 10);
  const Config forgetting_nothing{.cull_unmatched_after_keyframes = 10000, .min_found_ratio = 0.0};
  const auto [num_kept, num_landmarks_kept] = size_after_swaying(60, forgetting_nothing);
  EXPECT_GT(num_kept, 2 * num_later);
  EXPECT_GT(num_landmarks_kept, 2 * num_landmarks_later);
}

TEST(Cull, OfManyKeyframesOfOneViewOneGoesButNeverTheFirstOrOneOfALoop) {
  const features::TestWorld world = features::test_world(6, 2000);
  scene::MapVersion map = test_map(world, 1);
  for (int i = 1; i < 8; ++i) {
    map = apply(map,
                add_keyframe(map, test_tracked(map, features::test_view(world, i, {}), {}, kNone)));
  }
  const auto culled = cull_around(map, newest(map).id, {}, {}).culled_keyframes;
  ASSERT_EQ(culled.size(), 1U);
  EXPECT_GT(culled[0], core::KeyframeId(0));
  EXPECT_LT(culled[0], core::KeyframeId(4)) << "the latest are not tested yet";
  for (std::uint64_t i = 1; i < 4; ++i)
    map.loops.push_back({newest(map).id, core::KeyframeId(i), {}});
  EXPECT_TRUE(cull_around(map, newest(map).id, {}, {}).culled_keyframes.empty());
}

TEST(Cull, AKeyframeThatShowsWhatOthersDoNotStays) {
  const features::TestWorld world = features::test_world(6, 2000);
  scene::MapVersion map = test_map(world, 1);
  for (int i = 1; i < 8; ++i) {
    const core::Rigid3 turned{core::exp_so3({0.0, 0.5 * i, 0.0}), {0.0, 0.0, 0.0}};
    const features::View view = features::test_view(world, i, turned);
    map = apply(map, add_keyframe(map, test_tracked(map, view, turned, kNone)));
  }
  const Config testing_all{.cull_after_keyframes = 1};
  EXPECT_TRUE(cull_around(map, newest(map).id, testing_all, {}).culled_keyframes.empty());
}

}  // namespace
}  // namespace samewhere::map
