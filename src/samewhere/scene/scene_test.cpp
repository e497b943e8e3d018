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
  const LocalMap local = build_local_map(seen, core::KeyframeId(1), 5);
  ASSERT_EQ(local.size(), 1);
  const Eigen::Vector3d in_world = seen.keyframes[1].world_from_body * local.points_in_reference[0];
  EXPECT_LT((in_world - position_in_world(seen, seen.landmarks[0])).norm(), 1e-12);
  EXPECT_EQ(local.descriptors.rows, 1);
  EXPECT_EQ(build_local_map(seen, core::KeyframeId(0), 0).size(), 0)
      << "keyframe 0 shows no landmark in its slots";
}

}  // namespace
}  // namespace samewhere::scene
