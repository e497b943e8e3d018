#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/features/test_world.hpp>
#include <samewhere/scene/local_map.hpp>

namespace samewhere::scene {
namespace {

TEST(ChunkedVector, CopiesShareUntilOneIsWritten) {
  ChunkedVector<int, 4> first;
  for (int i = 0; i < 10; ++i) first.push_back(i);
  ChunkedVector<int, 4> second = first;
  EXPECT_EQ(&first[0], &second[0]) << "same chunk";
  second.edit(1) = 100;
  EXPECT_EQ(first[1], 1);
  EXPECT_EQ(second[1], 100);
  EXPECT_NE(&first[0], &second[0]);
  EXPECT_EQ(&first[8], &second[8]) << "other chunks are still shared";
}

TEST(ChunkedVector, AppendingToACopyLeavesTheOriginal) {
  ChunkedVector<int, 4> first;
  for (int i = 0; i < 5; ++i) first.push_back(i);
  ChunkedVector<int, 4> second = first;
  second.push_back(5);
  first.push_back(-5);
  EXPECT_EQ(first.back(), -5);
  EXPECT_EQ(second.back(), 5);
  EXPECT_THROW(first[6], core::ContractError);
}

TEST(ChunkedVector, WhatIsDroppedStaysInTheOther) {
  ChunkedVector<int, 4> first;
  for (int i = 0; i < 10; ++i) first.push_back(i);
  ChunkedVector<int, 4> second = first;
  second.shrink(6);
  second.push_back(-6);
  EXPECT_EQ(second.size(), 7U);
  EXPECT_EQ(second[5], 5);
  EXPECT_EQ(second[6], -6);
  EXPECT_EQ(first[6], 6);
  EXPECT_EQ(first[9], 9);
  EXPECT_THROW(second.shrink(8), core::ContractError);
  second.shrink(0);
  EXPECT_TRUE(second.empty());
}

Keyframe keyframe(std::uint64_t index, const features::View& view,
                  const core::Rigid3& world_from_body) {
  Keyframe made;
  made.id = core::KeyframeId(index);
  made.world_from_body = world_from_body;
  made.view = view;
  made.slots.resize(static_cast<std::size_t>(view.features->size()));
  return made;
}

Landmark landmark(std::uint64_t index, std::uint64_t anchor, const Eigen::Vector3d& position) {
  Landmark made;
  made.id = core::LandmarkId(index);
  made.anchor = core::KeyframeId(anchor);
  made.position_in_anchor = position;
  made.weight = weight_of_depth(position.z());
  return made;
}

// Two keyframes half a metre apart; the first feature of the second shows landmark 0, whose depth
// was 10 % too far.
class TwoKeyframes : public testing::Test {
 protected:
  TwoKeyframes() {
    const features::TestWorld world = features::test_world(1, 500);
    const core::Rigid3 second_pose{Eigen::Quaterniond::Identity(), {0.5, 0.0, 0.0}};
    view_ = features::test_view(world, 1, second_pose, 0.0);
    seen_in_second_ = *features::point_in_camera(view_, 0);
    Edit edit;
    edit.keyframes = {keyframe(0, features::test_view(world, 0, {}), {}),
                      keyframe(1, view_, second_pose)};
    edit.keyframes[1].odometry = {core::KeyframeId(0), second_pose, core::Matrix6d::Identity()};
    edit.landmarks = {landmark(0, 0, 1.1 * (second_pose * seen_in_second_))};
    map_ = apply(MapVersion{}, edit);
  }

  features::View view_;
  Eigen::Vector3d seen_in_second_;
  MapVersion map_;
};

TEST_F(TwoKeyframes, SeeingALandmarkAgainAveragesItsPosition) {
  const double before = (position_in_world(map_, map_.landmarks[0]) -
                         map_.keyframes[1].world_from_body * seen_in_second_)
                            .norm();
  Edit again;
  again.sightings = {{core::LandmarkId(0), {core::KeyframeId(1), 0}}};
  const MapVersion seen = apply(map_, again);
  const double after = (position_in_world(seen, seen.landmarks[0]) -
                        seen.keyframes[1].world_from_body * seen_in_second_)
                           .norm();
  EXPECT_LT(after, 0.6 * before);
  EXPECT_GT(after, 0.1 * before) << "a mean, not the last word";
  EXPECT_EQ(seen.keyframes[1].slots[0], core::LandmarkId(0));
  EXPECT_EQ(seen.landmarks[0].observations.size(), 1U);
  EXPECT_FALSE(map_.keyframes[1].slots[0].is_valid()) << "the older version does not change";
}

TEST_F(TwoKeyframes, LandmarksFollowTheirAnchor) {
  const core::Rigid3 shift{core::exp_so3({0.0, 0.3, 0.0}), {1.0, 2.0, 3.0}};
  Edit move;
  move.pose_changes = {{core::KeyframeId(0), shift}};
  const MapVersion moved = apply(map_, move);
  const Eigen::Vector3d expected = shift * position_in_world(map_, map_.landmarks[0]);
  EXPECT_LT((position_in_world(moved, moved.landmarks[0]) - expected).norm(), 1e-12);
}

TEST_F(TwoKeyframes, OdometryPosesIgnoreCorrections) {
  Edit move;
  move.pose_changes = {{core::KeyframeId(1), {Eigen::Quaterniond::Identity(), {9.0, 9.0, 9.0}}}};
  const MapVersion moved = apply(map_, move);
  EXPECT_GT(moved.keyframes[1].world_from_body.translation.norm(), 9.0);
  EXPECT_LT((odometry_poses(moved)[1].translation - Eigen::Vector3d(0.5, 0.0, 0.0)).norm(), 1e-12);
}

TEST_F(TwoKeyframes, AMergedLandmarkKeepsItsRowAndTheOtherShowsInItsPlace) {
  Edit more;
  more.landmarks = {landmark(1, 0, {0.0, 0.0, 2.0})};
  more.sightings = {{core::LandmarkId(0), {core::KeyframeId(0), 3}},
                    {core::LandmarkId(1), {core::KeyframeId(0), 4}},
                    {core::LandmarkId(1), {core::KeyframeId(1), 0}}};
  const MapVersion before = apply(map_, more);
  Edit one;
  one.merges = {{core::LandmarkId(1), core::LandmarkId(0), core::CandidateId(7)}};
  const MapVersion merged = apply(before, one);
  EXPECT_FALSE(is_live(merged.landmarks[1]));
  EXPECT_EQ(merged.landmarks[1].observations.size(), 2U) << "kept, to take the merge back";
  EXPECT_EQ(&survivor_of(merged, core::LandmarkId(1)), &merged.landmarks[0]);
  EXPECT_EQ(merged.merges[0].cause, core::CandidateId(7));
  EXPECT_EQ(merged.keyframes[1].slots[0], core::LandmarkId(0));
  EXPECT_EQ(merged.landmarks[0].observations.size(), 2U);
  EXPECT_FALSE(merged.keyframes[0].slots[4].is_valid()) << "keyframe 0 showed the survivor itself";
  EXPECT_EQ(merged.keyframes[0].slots[3], core::LandmarkId(0));
  EXPECT_THROW(apply(merged, one), core::ContractError) << "merged once";
}

TEST_F(TwoKeyframes, CulledLandmarksAndThoseWithoutObservationsAreNotShown) {
  Edit seen;
  seen.landmarks = {landmark(1, 0, {0.0, 0.0, 2.0})};
  seen.sightings = {{core::LandmarkId(0), {core::KeyframeId(1), 0}},
                    {core::LandmarkId(1), {core::KeyframeId(1), 1}}};
  const MapVersion before = apply(map_, seen);
  EXPECT_EQ(build_local_map(before, core::KeyframeId(1), {5, 5}).size(), 2);
  Edit gone;
  gone.culled_landmarks = {core::LandmarkId(0)};
  gone.removed_observations = {{core::LandmarkId(1), core::KeyframeId(1)}};
  const MapVersion after = apply(before, gone);
  EXPECT_EQ(build_local_map(after, core::KeyframeId(1), {5, 5}).size(), 0);
  EXPECT_EQ(num_live(after.landmarks), 0U);
  EXPECT_EQ(after.landmarks.size(), 2U) << "ids are positions";
  EXPECT_THROW(apply(after, gone), core::ContractError) << "removed once";
}

// A third keyframe that was tracked from the second.
MapVersion with_third(const MapVersion& map, const features::View& view) {
  Edit edit;
  edit.keyframes = {keyframe(2, view,
                             map.keyframes[1].world_from_body *
                                 core::Rigid3{Eigen::Quaterniond::Identity(), {0.0, 0.0, 0.4}})};
  edit.keyframes[0].odometry = {core::KeyframeId(1),
                                {Eigen::Quaterniond::Identity(), {0.0, 0.0, 0.3}},
                                4.0 * core::Matrix6d::Identity()};
  return apply(map, edit);
}

TEST_F(TwoKeyframes, ACulledKeyframeHangsOnItsParentAndHandsItsOdometryOn) {
  Edit edit;
  edit.sightings = {{core::LandmarkId(0), {core::KeyframeId(1), 0}}};
  edit.culled_keyframes = {core::KeyframeId(1)};
  const MapVersion three = with_third(map_, view_);
  const MapVersion culled = apply(three, edit);
  const auto pose_of = [&](std::uint64_t i) {
    return world_from_body(culled, core::KeyframeId(i)).translation;
  };
  EXPECT_LT((pose_of(1) - Eigen::Vector3d(0.5, 0.0, 0.0)).norm(), 1e-12);
  EXPECT_FALSE(is_live(culled.landmarks[0])) << "it had no other observation";
  const OdometryEdge& edge = *culled.keyframes[2].odometry;
  EXPECT_EQ(edge.parent, core::KeyframeId(0));
  EXPECT_LT((edge.parent_from_keyframe.translation - Eigen::Vector3d(0.5, 0.0, 0.3)).norm(), 1e-12);
  EXPECT_LT(edge.information(0, 0), 1.0) << "two errors add up";
  const auto odometry = odometry_poses(culled);
  EXPECT_EQ(odometry[1].translation, odometry_poses(three)[1].translation);
  EXPECT_LT((odometry[2].translation - odometry_poses(three)[2].translation).norm(), 1e-12);

  Edit move;
  move.pose_changes = {{core::KeyframeId(0), {Eigen::Quaterniond::Identity(), {0.0, 1.0, 0.0}}}};
  const MapVersion moved = apply(culled, move);
  EXPECT_LT(
      (world_from_body(moved, core::KeyframeId(1)).translation - Eigen::Vector3d(0.5, 1.0, 0.0))
          .norm(),
      1e-12)
      << "with its parent";
  EXPECT_EQ(holder_of(moved, core::KeyframeId(1)).keyframe, core::KeyframeId(0));
  move.pose_changes[0].keyframe = core::KeyframeId(1);
  EXPECT_THROW(apply(culled, move), core::ContractError) << "not by itself";
}

TEST_F(TwoKeyframes, WhatAnotherStillSeesHangsOnItWhenItsAnchorIsCulled) {
  MapVersion three = with_third(map_, view_);
  Edit seen;
  seen.landmarks = {landmark(1, 1, seen_in_second_)};
  seen.sightings = {{core::LandmarkId(1), {core::KeyframeId(1), 0}},
                    {core::LandmarkId(1), {core::KeyframeId(2), 0}}};
  seen.pose_changes = {
      {core::KeyframeId(2), {core::exp_so3({0.0, 0.2, 0.0}), Eigen::Vector3d::Zero()}}};
  three = apply(three, seen);
  const auto normal_in_world = [](const MapVersion& map) -> Eigen::Vector3d {
    const Landmark& landmark = map.landmarks[1];
    return world_from_body(map, landmark.anchor).rotation * landmark.normal_in_anchor;
  };
  Edit cull;
  cull.culled_keyframes = {core::KeyframeId(1)};
  const MapVersion culled = apply(three, cull);
  EXPECT_EQ(culled.landmarks[1].anchor, core::KeyframeId(2));
  const Eigen::Vector3d before = position_in_world(three, three.landmarks[1]);
  EXPECT_LT((position_in_world(culled, culled.landmarks[1]) - before).norm(), 1e-12);
  EXPECT_LT((normal_in_world(culled) - normal_in_world(three)).norm(), 1e-12);

  const core::Rigid3 aside{core::exp_so3({0.0, 0.4, 0.0}), {0.0, 3.0, 0.0}};
  Edit move;
  move.pose_changes = {{core::KeyframeId(2), aside}};
  const MapVersion moved = apply(culled, move);
  EXPECT_LT((position_in_world(moved, moved.landmarks[1]) - aside * before).norm(), 1e-12)
      << "with its observer, not with the parent of the culled one";
}

TEST_F(TwoKeyframes, AKeyframeCulledWhileAFalseLoopWasInTheMapReturnsToOdometryAfterWithdrawal) {
  const core::CandidateId cause(5);
  Edit close;
  close.loops = {{core::KeyframeId(2), core::KeyframeId(0), {}}};
  close.loops[0].cause = cause;
  close.pose_changes = {{core::KeyframeId(1), {Eigen::Quaterniond::Identity(), {9.0, 0.0, 0.0}}}};
  MapVersion map = apply(with_third(map_, view_), close);
  Edit cull;
  cull.culled_keyframes = {core::KeyframeId(1)};
  map = apply(map, cull);
  ASSERT_NEAR(world_from_body(map, core::KeyframeId(1)).translation.x(), 9.5, 1e-12);
  Edit take_back;
  take_back.withdrawn_loops = {cause};
  map = apply(map, take_back);
  EXPECT_NEAR(world_from_body(map, core::KeyframeId(1)).translation.x(), 0.5, 1e-12);
}

TEST_F(TwoKeyframes, ARefinementOutlivesTheKeyframeItWentThrough) {
  const core::Rigid3 refined{Eigen::Quaterniond::Identity(), {0.0, 0.0, 0.4}};
  Edit refine;
  refine.refinements = {{core::KeyframeId(2), refined}};
  const MapVersion three = apply(with_third(map_, view_), refine);
  EXPECT_EQ(three.keyframes[2].odometry->parent_from_keyframe.translation.z(), 0.3)
      << "what odometry measured stays";
  EXPECT_EQ(parent_from_keyframe(three.keyframes[2]).translation.z(), 0.4);
  Edit edit;
  edit.culled_keyframes = {core::KeyframeId(1)};
  const MapVersion culled = apply(three, edit);
  EXPECT_LT((parent_from_keyframe(culled.keyframes[2]).translation - Eigen::Vector3d(0.5, 0.0, 0.4))
                .norm(),
            1e-12);
}

TEST_F(TwoKeyframes, WhatAFullBundleSettledIsBetterUntilALocalOneComesAndNeverFreeOfLoops) {
  const auto along_z = [](double z_m) {
    return core::Rigid3{Eigen::Quaterniond::Identity(), {0.0, 0.0, z_m}};
  };
  Edit settle;
  settle.settled = {{core::KeyframeId(2), along_z(0.4)}};
  const MapVersion three = apply(with_third(map_, view_), settle);
  EXPECT_EQ(settled_parent_from_keyframe(three.keyframes[2]).translation.z(), 0.4);
  EXPECT_EQ(parent_from_keyframe(three.keyframes[2]).translation.z(), 0.3);
  Edit cull;
  cull.culled_keyframes = {core::KeyframeId(1)};
  const MapVersion culled = apply(three, cull);
  EXPECT_LT((settled_parent_from_keyframe(culled.keyframes[2]).translation -
             Eigen::Vector3d(0.5, 0.0, 0.4))
                .norm(),
            1e-12);
  Edit refine;
  refine.refinements = {{core::KeyframeId(2), along_z(0.7)}};
  EXPECT_EQ(settled_parent_from_keyframe(apply(three, refine).keyframes[2]).translation.z(), 0.7);
}

TEST_F(TwoKeyframes, TheFirstKeyframeAndOneOfALoopCannotGo) {
  Edit first;
  first.culled_keyframes = {core::KeyframeId(0)};
  EXPECT_THROW(apply(map_, first), core::ContractError);
  Edit loop;
  loop.loops = {{core::KeyframeId(1), core::KeyframeId(0), {}}};
  const MapVersion closed = apply(map_, loop);
  Edit of_loop;
  of_loop.culled_keyframes = {core::KeyframeId(1)};
  EXPECT_THROW(apply(closed, of_loop), core::ContractError);
}

TEST_F(TwoKeyframes, IdsThatDoNotContinueTheMapAreABrokenPromise) {
  Edit edit;
  edit.keyframes = {keyframe(5, view_, {})};
  EXPECT_THROW(apply(map_, edit), core::ContractError);
  Edit landmarks;
  landmarks.landmarks = {landmark(7, 0, {0, 0, 1})};
  EXPECT_THROW(apply(map_, landmarks), core::ContractError);
}

TEST_F(TwoKeyframes, TheLocalMapSpeaksInTheReferencesFrame) {
  Edit again;
  again.sightings = {{core::LandmarkId(0), {core::KeyframeId(1), 0}}};
  const MapVersion seen = apply(map_, again);
  const LocalMap local = build_local_map(seen, core::KeyframeId(1), {5, 5});
  ASSERT_EQ(local.size(), 1);
  const Eigen::Vector3d in_world = seen.keyframes[1].world_from_body * local.points_in_reference[0];
  EXPECT_LT((in_world - position_in_world(seen, seen.landmarks[0])).norm(), 1e-12);
  EXPECT_EQ(local.descriptors.rows, 1);
  EXPECT_EQ(build_local_map(seen, core::KeyframeId(0), {}).size(), 0)
      << "keyframe 0 shows no landmark in its slots";
}

TEST_F(TwoKeyframes, WhatTheReferenceShowsIsNearAndComesFirst) {
  Edit more;
  more.landmarks = {landmark(1, 0, {0.0, 0.0, 2.0}), landmark(2, 0, {0.1, 0.0, 2.0})};
  const auto sighting = [](std::uint64_t id, std::uint64_t keyframe, int slot) {
    return Sighting{core::LandmarkId(id), {core::KeyframeId(keyframe), slot}};
  };
  more.sightings = {sighting(1, 0, 1), sighting(2, 0, 2), sighting(2, 1, 2)};
  const MapVersion seen = apply(map_, more);
  const LocalMap local = build_local_map(seen, core::KeyframeId(1), {.all = 1, .near = 0});
  EXPECT_EQ(local.landmarks, (std::vector{core::LandmarkId(2), core::LandmarkId(1)}));
  EXPECT_EQ(local.num_near, 1);
  EXPECT_EQ(build_local_map(seen, core::KeyframeId(1), {.all = 1, .near = 5}).num_near, 2);
}

}  // namespace
}  // namespace samewhere::scene
