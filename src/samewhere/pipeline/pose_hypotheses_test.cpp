#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include <samewhere/features/test_world.hpp>
#include <samewhere/map/mapper.hpp>
#include <samewhere/map/test_map.hpp>
#include <samewhere/pipeline/pose_hypotheses.hpp>

namespace samewhere::pipeline {
namespace {

constexpr int kNumViews = 5;
const core::KeyframeId kHere(0);
const core::KeyframeId kThere(1);

bool anywhere(const core::FramePose& /*pose*/) { return true; }

const core::Rigid3 kFar{Eigen::Quaterniond::Identity(), {50.0, 0.0, 0.0}};

// This share of the points gets random descriptors.
features::TestWorld partly_different(features::TestWorld world, double share) {
  core::Random random(9);
  for (auto& descriptor : world.descriptors) {
    if (random.uniform(0.0, 1.0) >= share) continue;
    for (auto& byte : descriptor) byte = static_cast<std::uint8_t>(random.index(256));
  }
  return world;
}

// One place twice in one map; a share of the points differs.
scene::MapVersion map_with_twins(const features::TestWorld& here, double different) {
  scene::MapVersion map;
  map = apply(map, map::start_map(map, features::test_view(here, 0, {}), {}));
  return apply(map, map::start_map(
                        map, features::test_view(partly_different(here, different), 1, {}), kFar));
}

class PoseHypothesesTest : public testing::Test {
 protected:
  // View `frame` of a static camera that shows what the first keyframe shows.
  std::optional<RelocalizedPose> evaluate(const scene::MapVersion& map, int frame,
                                          const std::vector<Place>& places,
                                          const IsReachable& is_reachable = anywhere) {
    return hypotheses_.evaluate(features::test_view(world_, 10 + frame, {}), map, places,
                                {kNumViews}, is_reachable);
  }

  features::TestWorld world_ = features::test_world(5);
  Config config_;
  track::Tracker tracker_{{config_.track, config_.features, config_.optimize, 0}};
  PoseHypotheses hypotheses_{config_, tracker_};
  std::vector<Place> both_ = {{kThere, core::Rigid3{}, true}, {kHere, core::Rigid3{}, true}};
};

TEST_F(PoseHypothesesTest, NeverAcceptsAPlaceThatTheMapHasTwice) {
  const scene::MapVersion map = map_with_twins(world_, 0.0);
  for (int i = 0; i < 4 * kNumViews; ++i) EXPECT_FALSE(evaluate(map, i, both_)) << "view " << i;
}

TEST_F(PoseHypothesesTest, AcceptsTheBetterOfTwoLookAlikePlacesAfterEnoughViews) {
  const scene::MapVersion map = map_with_twins(world_, 0.5);
  for (int i = 0; i < kNumViews - 1; ++i) EXPECT_FALSE(evaluate(map, i, both_)) << "view " << i;
  const auto found = evaluate(map, kNumViews - 1, both_);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->track.pose.reference_keyframe, kHere);
  EXPECT_LT(found->track.pose.reference_from_frame.translation.norm(), 0.02);
}

TEST_F(PoseHypothesesTest, KeepsACompetingHypothesisThatIsNoLongerACandidate) {
  const scene::MapVersion map = map_with_twins(world_, 0.0);
  const std::vector<Place> one = {both_[1]};
  EXPECT_FALSE(evaluate(map, 0, both_));
  for (int i = 1; i < 4 * kNumViews; ++i) EXPECT_FALSE(evaluate(map, i, one)) << "view " << i;
}

TEST_F(PoseHypothesesTest, AcceptsAHypothesisAfterTheCameraLeavesTheLookAlikePlace) {
  const scene::MapVersion map = map_with_twins(world_, 0.0);
  for (int i = 0; i < 2 * kNumViews; ++i) EXPECT_FALSE(evaluate(map, i, both_)) << "view " << i;
  const scene::MapVersion different = map_with_twins(world_, 0.7);
  std::optional<RelocalizedPose> found;
  for (int i = 0; i < 2 * kNumViews && !found; ++i) found = evaluate(different, 20 + i, {});
  ASSERT_TRUE(found) << "the evidence of the look-alike place is dropped after some views";
  EXPECT_EQ(found->track.pose.reference_keyframe, kHere);
}

TEST_F(PoseHypothesesTest, IgnoresAPlaceThatIsNotReachable) {
  const scene::MapVersion map = map_with_twins(world_, 0.0);
  const IsReachable near_here = [](const core::FramePose& pose) {
    return pose.reference_keyframe == kHere;
  };
  std::optional<RelocalizedPose> found;
  for (int i = 0; i < kNumViews; ++i) found = evaluate(map, i, both_, near_here);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->track.pose.reference_keyframe, kHere);
}

// The loop verifier recognizes it, but no landmark of the map can be tracked there.
TEST_F(PoseHypothesesTest, ARecognizedPlaceThatCannotBeTrackedCompetesWhileItIsRecognized) {
  const scene::MapVersion map = map_with_twins(world_, 1.0);
  for (int i = 0; i < 2 * kNumViews; ++i) EXPECT_FALSE(evaluate(map, i, both_)) << "view " << i;
  std::vector<Place> unrecognised = both_;
  unrecognised[0].is_recognised = false;
  const auto found = evaluate(map, 2 * kNumViews, unrecognised);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->track.pose.reference_keyframe, kHere);
}

TEST_F(PoseHypothesesTest, IgnoresARecognizedPlaceThatIsNotReachableAndCannotBeTracked) {
  const scene::MapVersion map = map_with_twins(world_, 1.0);
  const IsReachable near_here = [](const core::FramePose& pose) {
    return pose.reference_keyframe == kHere;
  };
  std::optional<RelocalizedPose> found;
  for (int i = 0; i < kNumViews; ++i) found = evaluate(map, i, both_, near_here);
  EXPECT_TRUE(found);
}

void append_features(features::Features& features, const features::Features& more, double share) {
  core::Random random(4);
  for (int i = 0; i < more.size(); ++i) {
    if (random.uniform(0.0, 1.0) >= share) continue;
    const auto k = static_cast<std::size_t>(i);
    features.raw_px.push_back(more.raw_px[k]);
    features.undistorted_px.push_back(more.undistorted_px[k]);
    features.depth_m.push_back(more.depth_m[k]);
    features.right_x_px.push_back(more.right_x_px[k]);
    features.octave.push_back(more.octave[k]);
    features.angle_rad.push_back(more.angle_rad[k]);
    features.rgb.push_back(more.rgb[k]);
    features.descriptors.push_back(more.descriptors.row(i));
  }
}

// With a share of the features.
features::View thinned(const features::View& view, double share) {
  auto features = std::make_shared<features::Features>();
  features->descriptors = cv::Mat(0, 32, CV_8U);
  append_features(*features, *view.features, share);
  features::View thin = view;
  thin.features = features;
  return thin;
}

// As glass shows the scene behind it, too.
features::View shining_through(const features::View& view, const features::View& behind) {
  auto features = std::make_shared<features::Features>();
  features->descriptors = cv::Mat(0, 32, CV_8U);
  append_features(*features, *view.features, 1.0);
  append_features(*features, *behind.features, 1.0);
  features::View both = view;
  both.features = features;
  return both;
}

TEST_F(PoseHypothesesTest, ComparesInliersPerVisibleLandmark) {
  scene::MapVersion map;
  map = apply(map, map::start_map(map, thinned(features::test_view(world_, 0, {}), 0.55), {}));
  map = apply(map,
              map::start_map(map, features::test_view(partly_different(world_, 0.1), 1, {}), kFar));
  for (int i = 0; i < 4 * kNumViews; ++i)
    EXPECT_FALSE(evaluate(map, i, both_))
        << "view " << i << ": the look-alike place has more inliers";
}

// Less than half of the landmarks of the look-alike place: the two are not comparable.
TEST_F(PoseHypothesesTest, ARecognizedPlaceWithTooFewLandmarksCompetesWhileItIsRecognized) {
  scene::MapVersion map;
  map = apply(map, map::start_map(map, thinned(features::test_view(world_, 0, {}), 0.3), {}));
  map = apply(map,
              map::start_map(map, features::test_view(partly_different(world_, 0.1), 1, {}), kFar));
  for (int i = 0; i < 2 * kNumViews; ++i) EXPECT_FALSE(evaluate(map, i, both_)) << "view " << i;
  EXPECT_TRUE(evaluate(map, 2 * kNumViews, {both_[0]})) << "else this shows nothing";
}

TEST_F(PoseHypothesesTest, KeepsAHypothesisWhereItsMapEnds) {
  const core::Rigid3 turned{core::exp_so3({0.0, 0.7, 0.0}), {0.0, 0.0, 0.0}};
  // the map of the look-alike place reaches farther
  scene::MapVersion map;
  map = apply(map, map::start_map(map, features::test_view(world_, 0, {}), kFar));
  map = apply(map,
              map::add_keyframe(map, map::test_tracked(map, features::test_view(world_, 1, turned),
                                                       kFar * turned, [](auto) { return false; })));
  map = apply(map, map::start_map(map, features::test_view(world_, 2, {}), {}));
  const core::KeyframeId here(2);
  const std::vector<Place> both = {{core::KeyframeId(0), core::Rigid3{}, true},
                                   {here, core::Rigid3{}, true}};
  for (int i = 0; i < 2 * kNumViews; ++i) {
    const core::Rigid3 turning{core::exp_so3({0.0, 0.07 * i, 0.0}), {0.0, 0.0, 0.0}};
    EXPECT_FALSE(hypotheses_.evaluate(features::test_view(world_, 10 + i, turning), map,
                                      i == 0 ? both : std::vector<Place>{}, {kNumViews}, anywhere))
        << "view " << i;
  }
}

enum class Side { kLeft, kRight };

// The points on one side of the z axis, and a share of points there that are not visible again.
features::TestWorld one_side(const features::TestWorld& world, Side side, double junk_share) {
  const features::TestWorld junk = features::test_world(77);
  features::TestWorld half;
  const auto take = [&half, side](const features::TestWorld& from, double share) {
    core::Random random(6);
    for (std::size_t i = 0; i < from.points.size(); ++i) {
      const bool is_left = from.points[i].x() < 0.0;
      if (is_left != (side == Side::kLeft) || random.uniform(0.0, 1.0) >= share) continue;
      half.points.push_back(from.points[i]);
      half.descriptors.push_back(from.descriptors[i]);
    }
  };
  take(world, 1.0);
  take(junk, junk_share);
  return half;
}

TEST_F(PoseHypothesesTest, ComparesInTheHalfOfTheViewThatBothMapsShow) {
  const features::View left = features::test_view(one_side(world_, Side::kLeft, 0.6), 0, {});
  const scene::MapVersion alone = apply({}, map::start_map({}, left, {}));
  const scene::MapVersion both =
      apply(alone, map::start_map(alone, features::test_view(world_, 1, {}), kFar));
  for (int i = 0; i < 2 * kNumViews; ++i) EXPECT_FALSE(evaluate(both, i, both_)) << "view " << i;
  hypotheses_.reset();
  const scene::MapVersion different =
      apply(alone,
            map::start_map(alone, features::test_view(partly_different(world_, 0.7), 1, {}), kFar));
  std::optional<RelocalizedPose> found;
  for (int i = 0; i < kNumViews; ++i) found = evaluate(different, i, both_);
  ASSERT_TRUE(found) << "half a view is enough";
  EXPECT_EQ(found->track.pose.reference_keyframe, kHere);
}

TEST_F(PoseHypothesesTest, IsUndecidedWhereTheMapsShowDifferentHalvesOfTheView) {
  const features::View left = features::test_view(one_side(world_, Side::kLeft, 0.0), 0, {});
  const features::View right = features::test_view(one_side(world_, Side::kRight, 0.0), 1, {});
  scene::MapVersion map = apply({}, map::start_map({}, left, {}));
  map = apply(map, map::start_map(map, right, kFar));
  for (int i = 0; i < 2 * kNumViews; ++i) EXPECT_FALSE(evaluate(map, i, both_)) << "view " << i;
  hypotheses_.reset();
  std::optional<RelocalizedPose> found;
  for (int i = 0; i < kNumViews; ++i) found = evaluate(map, i, {both_[0]});
  EXPECT_TRUE(found) << "else this shows nothing";
}

TEST_F(PoseHypothesesTest, MergedHypothesesKeepTheBetterEvidence) {
  const core::Rigid3 aside{Eigen::Quaterniond::Identity(), {1.2, 0.0, 0.0}};
  scene::MapVersion map;
  map = apply(map, map::start_map(map, thinned(features::test_view(world_, 0, {}), 0.7), {}));
  map = apply(map, map::start_map(map, features::test_view(world_, 1, aside), aside));
  map = apply(map, map::start_map(map, features::test_view(world_, 2, {}), kFar));
  const std::vector<Place> places = {{core::KeyframeId(0), core::Rigid3{}, true},
                                     {core::KeyframeId(1), core::Rigid3{}, true},
                                     {core::KeyframeId(2), core::Rigid3{}, true}};
  const features::View first = shining_through(
      features::test_view(world_, 10, {}), thinned(features::test_view(world_, 3, aside), 0.15));
  const auto walk = [&](const std::vector<Place>& candidates) {
    std::optional<RelocalizedPose> found =
        hypotheses_.evaluate(first, map, candidates, {kNumViews}, anywhere);
    for (int i = 1; i < 2 * kNumViews && !found; ++i) {
      const core::Rigid3 moved{Eigen::Quaterniond::Identity(), {0.1 * i, 0.0, 0.0}};
      found = hypotheses_.evaluate(features::test_view(world_, 10 + i, moved), map, {}, {kNumViews},
                                   anywhere);
    }
    hypotheses_.reset();
    return found;
  };
  EXPECT_FALSE(walk(places));
  EXPECT_TRUE(walk({places[0], places[1]})) << "else this shows nothing";
}

class WeakView : public PoseHypothesesTest {
 protected:
  WeakView() : weak_(thinned(features::test_view(world_, 10, {}), 0.03)) {
    map_ = apply(map_, map::start_map(map_, features::test_view(world_, 0, {}), {}));
  }

  std::optional<RelocalizedPose> found(const std::vector<Place>& places, bool may_be_weak) {
    return hypotheses_.evaluate(weak_, map_, places, {1, may_be_weak}, anywhere);
  }

  scene::MapVersion map_;
  features::View weak_;
  std::vector<Place> here_ = {{kHere, core::Rigid3{}, true}};
};

TEST_F(WeakView, IsAcceptedOnlyIfWeakPosesMayBe) {
  EXPECT_FALSE(found(here_, false));
  const auto place = found(here_, true);
  ASSERT_TRUE(place);
  EXPECT_EQ(place->track.pose.status, core::FrameStatus::kWeak);
  EXPECT_LT(place->track.pose.reference_from_frame.translation.norm(), 0.05);
}

TEST_F(WeakView, IsNotAcceptedBesideAnotherHypothesis) {
  map_ = map_with_twins(world_, 0.0);
  for (int i = 0; i < kNumViews; ++i) EXPECT_FALSE(found(both_, true)) << "view " << i;
}

TEST_F(PoseHypothesesTest, AnUnrecognizedPlaceCompetesAndIsNotAccepted) {
  const scene::MapVersion map = map_with_twins(world_, 0.5);
  std::vector<Place> looks_alike = both_;
  looks_alike[1].is_recognised = false;
  for (int i = 0; i < 2 * kNumViews; ++i)
    EXPECT_FALSE(evaluate(map, i, looks_alike)) << "view " << i;
}

}  // namespace
}  // namespace samewhere::pipeline
