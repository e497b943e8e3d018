#include <gtest/gtest.h>

#include <samewhere/features/test_world.hpp>
#include <samewhere/track/drift_model.hpp>
#include <samewhere/track/tracker.hpp>

namespace samewhere::track {
namespace {

// The local map of a keyframe at the origin that sees a test world: its features are its landmarks.
scene::LocalMap local_map_of(const features::View& view) {
  scene::LocalMap map;
  map.reference = core::KeyframeId(0);
  map.descriptors = view.features->descriptors;
  for (int i = 0; i < view.features->size(); ++i) {
    const Eigen::Vector3d point = *features::point_in_camera(view, i);
    map.landmarks.emplace_back(static_cast<std::uint64_t>(i));
    map.points_in_reference.push_back(point);
    map.range_m.push_back(point.norm());
    map.octave.push_back(0);
  }
  map.num_near = map.size();
  return map;
}

class TestTracker : public testing::Test {
 protected:
  features::TestWorld world_ = features::test_world(5);
  scene::LocalMap map_ = local_map_of(features::test_view(world_, 0, {}));
  Tracker tracker_{TrackerSettings{}};
  core::Rigid3 moved_{core::exp_so3({0.02, 0.15, -0.01}), {0.1, -0.02, 0.2}};
};

double error_of(const Track& track, const core::Rigid3& truth) {
  return core::log_r3so3(inverse(truth) * track.pose.reference_from_frame).norm();
}

TEST_F(TestTracker, FindsThePoseFromAGoodGuess) {
  const auto track =
      tracker_.track(features::test_view(world_, 1, moved_), map_, {moved_.rotation, {0, 0, 0.2}});
  ASSERT_TRUE(track);
  EXPECT_LT(error_of(*track, moved_), 0.005);
  EXPECT_EQ(track->pose.status, core::FrameStatus::kTracking);
  EXPECT_TRUE(track->pose.is_measured);
  EXPECT_EQ(static_cast<int>(track->matches.size()), track->pose.num_inliers);
  EXPECT_LT(track->reprojection_rmse_px, 1.0);
}

TEST_F(TestTracker, FindsThePoseWithoutOrWithAWrongGuess) {
  const features::View view = features::test_view(world_, 1, moved_);
  const core::Rigid3 wrong{core::exp_so3({0.0, -0.6, 0.2}), {-1.0, 0.5, 0.0}};
  for (const auto& track :
       {tracker_.track_anywhere(view, map_), tracker_.track(view, map_, wrong)}) {
    ASSERT_TRUE(track);
    EXPECT_LT(error_of(*track, moved_), 0.005);
  }
}

TEST_F(TestTracker, WithoutAPredictionTheNearLandmarksAreMatched) {
  const features::View view = features::test_view(world_, 1, moved_);
  map_.num_near = 5;
  EXPECT_FALSE(tracker_.track_anywhere(view, map_));
  map_.num_near = 60;
  const auto track = tracker_.track_anywhere(view, map_);
  ASSERT_TRUE(track);
  EXPECT_GT(track->matches.size(), 60U) << "with a pose all visible landmarks are searched";
}

// Landmarks that look like features of the view and stand where a wrong pose would see them.
scene::LocalMap with_decoys(scene::LocalMap map, const features::View& view,
                            const core::Rigid3& wrong, int num_decoys) {
  for (int i = 0; i < num_decoys; ++i) {
    const Eigen::Vector3d point = wrong * *features::point_in_camera(view, i);
    map.landmarks.emplace_back(static_cast<std::uint64_t>(map.size()));
    map.points_in_reference.push_back(point);
    map.range_m.push_back(point.norm());
    map.octave.push_back(0);
    map.descriptors.push_back(view.features->descriptors.row(i));
  }
  return map;
}

TEST_F(TestTracker, AFewThatAgreeNearAWrongGuessDoNotWin) {
  const features::View view = features::test_view(world_, 1, moved_);
  const core::Rigid3 wrong =
      moved_ * core::Rigid3{core::exp_so3({0.0, 0.06, 0.0}), Eigen::Vector3d::Zero()};
  const scene::LocalMap map = with_decoys(map_, view, wrong, 60);
  TrackerSettings credulous;
  credulous.track.sure_inliers = 6;
  const auto fooled = Tracker(credulous).track(view, map, wrong);
  ASSERT_TRUE(fooled);
  ASSERT_LT(error_of(*fooled, wrong), 0.01) << "the decoys must be good enough";
  ASSERT_GT(fooled->pose.num_inliers, credulous.track.weak_inliers);
  const auto track = tracker_.track(view, map, wrong);
  ASSERT_TRUE(track);
  EXPECT_LT(error_of(*track, moved_), 0.005);
}

TEST_F(TestTracker, WorksOnPixelsAloneWhereTheFrameHasNoDepth) {
  const auto track = tracker_.track(features::test_view(world_, 1, moved_, 0.3, false), map_, {});
  ASSERT_TRUE(track);
  EXPECT_LT(error_of(*track, moved_), 0.01);
}

TEST_F(TestTracker, AnotherPlaceIsNoPose) {
  const features::TestWorld elsewhere = features::test_world(6);
  EXPECT_FALSE(tracker_.track(features::test_view(elsewhere, 1, {}), map_, {}));
}

TEST_F(TestTracker, AViewWithoutFeaturesIsNoPose) {
  EXPECT_FALSE(tracker_.track(features::test_view({}, 1, {}), map_, {}));
  EXPECT_FALSE(tracker_.track(features::test_view(world_, 1, {}), scene::LocalMap{}, {}));
}

TEST_F(TestTracker, FewLandmarksMakeAWeakPose) {
  features::TestWorld sparse = world_;
  // a view of the world of which only every twelfth point is left
  features::TestWorld rest;
  for (std::size_t i = 0; i < sparse.points.size(); i += 12) {
    rest.points.push_back(sparse.points[i]);
    rest.descriptors.push_back(sparse.descriptors[i]);
  }
  const features::View view = features::test_view(rest, 1, moved_);
  const auto track = tracker_.track(view, map_, moved_);
  ASSERT_TRUE(track) << view.features->size() << " features";
  EXPECT_LT(track->pose.num_inliers, 60);
  TrackerSettings strict;
  strict.track.weak_inliers = 200;
  EXPECT_EQ(Tracker(strict).track(view, map_, moved_)->pose.status, core::FrameStatus::kWeak);
}

TEST_F(TestTracker, FeaturesRefineThePoseOfDepthPictures) {
  const features::View view = features::test_view(world_, 1, moved_);
  const core::Rigid3 near =
      moved_ * core::Rigid3{core::exp_so3({0.0, 0.004, 0.0}), {0.01, 0.0, 0.0}};
  const Track track = tracker_.track_at(view, map_, near, {});
  EXPECT_LT(error_of(track, moved_), 0.005);
  EXPECT_EQ(track.pose.status, core::FrameStatus::kTracking);
}

TEST_F(TestTracker, DepthPicturesHoldAWeakPoseWhereFeaturesHoldNone) {
  const features::View nothing = features::test_view({}, 1, {});
  const Track track = tracker_.track_at(nothing, map_, moved_, {});
  EXPECT_EQ(error_of(track, moved_), 0.0);
  EXPECT_EQ(track.pose.status, core::FrameStatus::kWeak);
  EXPECT_EQ(track.pose.num_inliers, 0);
  EXPECT_TRUE(track.pose.is_measured);
}

TEST_F(TestTracker, FeaturesThatLeadFarAwayDoNotMoveThePoseOfDepthPictures) {
  const features::View view = features::test_view(world_, 1, moved_);
  const core::Rigid3 elsewhere =
      moved_ * core::Rigid3{core::exp_so3({0.0, 0.0, 0.0}), {0.0, 0.0, 0.2}};
  TrackerSettings wide;
  wide.track.refine_radius_px = 60.0;
  ASSERT_TRUE(are_apart(elsewhere, moved_));
  const Track track = Tracker(wide).track_at(view, map_, elsewhere, {});
  EXPECT_LT(error_of(track, elsewhere), 1e-9);
  EXPECT_EQ(track.pose.status, core::FrameStatus::kWeak);
}

}  // namespace
}  // namespace samewhere::track
