#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/features/test_world.hpp>
#include <samewhere/map/mapper.hpp>

namespace samewhere::map {
namespace {

class TestMapper : public testing::Test {
 protected:
  TestMapper() { map_ = apply(scene::MapVersion{}, start_map(map_, first_, core::Rigid3{})); }

  // The view from `reference_from_frame`, every feature of which shows the landmark of the same
  // point if the first view has it.
  scene::TrackedView tracked_at(const core::Rigid3& reference_from_frame) const {
    scene::TrackedView tracked{features::test_view(world_, 1, reference_from_frame), {}, {}};
    tracked.pose.reference_keyframe = core::KeyframeId(0);
    tracked.pose.reference_from_frame = reference_from_frame;
    for (const auto& match : features::match_pair(first_.features->descriptors,
                                                  tracked.view.features->descriptors, {})) {
      tracked.landmarks.emplace_back(
          match.second, map_.keyframes[0].slots[static_cast<std::size_t>(match.first)]);
    }
    return tracked;
  }

  features::TestWorld world_ = features::test_world(3);
  features::View first_ = features::test_view(world_, 0, {});
  scene::MapVersion map_;
  Config config_;
};

TEST_F(TestMapper, TheFirstKeyframeMakesALandmarkOfEveryFeatureWithDepth) {
  EXPECT_EQ(map_.keyframes.size(), 1U);
  EXPECT_EQ(static_cast<int>(map_.landmarks.size()), first_.features->size());
  EXPECT_FALSE(map_.keyframes[0].odometry);
  for (std::size_t i = 0; i < 20; ++i) {
    const scene::Landmark& landmark = map_.landmarks[i];
    EXPECT_LT((position_in_world(map_, landmark) -
               *features::point_in_camera(first_, static_cast<int>(i)))
                  .norm(),
              1e-9);
    EXPECT_NEAR(landmark.normal_in_anchor.norm(), 1.0, 1e-9);
  }
}

TEST_F(TestMapper, StandingStillAddsNoKeyframe) {
  EXPECT_FALSE(is_worth_keeping(map_, tracked_at({}), config_));
}

TEST_F(TestMapper, MovingTurningAndLosingSightEachAddOne) {
  EXPECT_TRUE(
      is_worth_keeping(map_, tracked_at({Eigen::Quaterniond::Identity(), {0.8, 0, 0}}), config_));
  EXPECT_TRUE(
      is_worth_keeping(map_, tracked_at({core::exp_so3({0.0, 0.3, 0.0}), {0, 0, 0}}), config_));
  scene::TrackedView blind = tracked_at({});
  blind.landmarks.resize(blind.landmarks.size() / 3);
  EXPECT_TRUE(is_worth_keeping(map_, blind, config_));
}

// A map that two keyframes made, and a view of what both show from elsewhere, so much later.
class ALongStay : public TestMapper {
 protected:
  ALongStay() { map_ = apply(map_, add_keyframe(map_, tracked_at({}))); }

  scene::TrackedView tracked_after(double seconds) const {
    scene::TrackedView tracked = tracked_at({Eigen::Quaterniond::Identity(), {0.8, 0, 0}});
    tracked.view.stamp_s = first_.stamp_s + seconds;
    return tracked;
  }

  // The second keyframe, and so the whole session, is of this one.
  void put_into_session(std::uint16_t session, double stamp_s) {
    scene::Keyframe& second = map_.keyframes.edit(1);
    second.view.frame = core::FrameId(0, session);
    second.view.stamp_s = stamp_s;
  }
};

TEST_F(ALongStay, AddsNoKeyframeOfWhatTheMapHasKnownForMinutes) {
  EXPECT_TRUE(is_worth_keeping(map_, tracked_after(60.0), config_));
  EXPECT_FALSE(is_worth_keeping(map_, tracked_after(180.0), config_));
}

TEST_F(ALongStay, AddsAKeyframeOfWhatOnlyYoungKeyframesHaveSeen) {
  put_into_session(0, 170.0);
  scene::MapVersion young = map_;
  for (std::size_t i = 0; i < young.landmarks.size(); ++i) {
    auto& seen = young.landmarks.edit(i).observations;
    std::erase_if(seen, [](const scene::Observation& o) { return o.keyframe.index() == 0; });
    if (!seen.empty()) seen.push_back(seen.front());
  }
  EXPECT_FALSE(is_worth_keeping(map_, tracked_after(180.0), config_));
  EXPECT_TRUE(is_worth_keeping(young, tracked_after(180.0), config_));
}

TEST_F(ALongStay, AddsAKeyframeWhereMostOfWhatIsShownIsNewOrLittleIsKnown) {
  scene::TrackedView tracked = tracked_after(180.0);
  const auto all = tracked.landmarks;
  scene::MapVersion once = map_;
  for (std::size_t i = 0; 5 * i < 3 * all.size(); ++i)
    once.landmarks.edit(all[i].second.index()).observations.resize(1);
  EXPECT_TRUE(is_worth_keeping(once, tracked, config_));
  EXPECT_FALSE(is_worth_keeping(map_, tracked, config_));
  tracked.landmarks.resize(60);
  EXPECT_TRUE(is_worth_keeping(map_, tracked, config_));
}

TEST_F(ALongStay, CountsFromTheBeginOfTheSessionForWhatAnEarlierOneSaw) {
  put_into_session(1, 1000.0);
  scene::TrackedView tracked = tracked_after(1060.0);
  tracked.view.frame = core::FrameId(1, 1);
  EXPECT_TRUE(is_worth_keeping(map_, tracked, config_));
  tracked.view.stamp_s = first_.stamp_s + 1180.0;
  EXPECT_FALSE(is_worth_keeping(map_, tracked, config_));
}

TEST_F(TestMapper, AViewWithoutDepthIsNeverAKeyframe) {
  scene::TrackedView blind{features::test_view(world_, 1, {}, 0.3, false), {}, {}};
  blind.pose.reference_keyframe = core::KeyframeId(0);
  EXPECT_FALSE(is_worth_keeping(map_, blind, config_));
  EXPECT_FALSE(can_start(blind.view, config_));
}

TEST_F(TestMapper, ASecondKeyframeSeesOldLandmarksAgainAndAddsNewOnes) {
  const core::Rigid3 moved{core::exp_so3({0.0, 0.4, 0.0}), {0.3, 0.0, 0.1}};
  const scene::TrackedView tracked = tracked_at(moved);
  const scene::MapVersion grown = apply(map_, add_keyframe(map_, tracked));
  ASSERT_EQ(grown.keyframes.size(), 2U);
  const scene::Keyframe& second = grown.keyframes[1];
  ASSERT_TRUE(second.odometry);
  EXPECT_EQ(second.odometry->parent, core::KeyframeId(0));
  EXPECT_LT(core::log_r3so3(inverse(moved) * second.world_from_body).norm(), 1e-9);
  EXPECT_EQ(grown.landmarks.size(),
            map_.landmarks.size() + second.slots.size() - tracked.landmarks.size());
  const auto [feature, landmark] = tracked.landmarks.front();
  EXPECT_EQ(second.slots[static_cast<std::size_t>(feature)], landmark);
  EXPECT_EQ(grown.at(landmark).observations.size(), 2U);
  EXPECT_EQ(grown.at(second.slots.back()).observations.back().keyframe, second.id);
}

TEST_F(TestMapper, WhatPassesByBecomesNoLandmarkByItsDepth) {
  scene::TrackedView tracked = tracked_at({core::exp_so3({0.0, 0.4, 0.0}), {0.3, 0.0, 0.1}});
  const auto num_new = [&] {
    return apply(map_, add_keyframe(map_, tracked)).landmarks.size() - map_.landmarks.size();
  };
  const std::size_t num_all = num_new();
  std::vector<bool> is_known(static_cast<std::size_t>(tracked.view.features->size()), false);
  for (const auto& shown : tracked.landmarks)
    is_known[static_cast<std::size_t>(shown.first)] = true;
  for (int i = 0; i < tracked.view.features->size() && tracked.passing.size() < 10; ++i)
    if (!is_known[static_cast<std::size_t>(i)]) tracked.passing.push_back(i);
  ASSERT_EQ(tracked.passing.size(), 10U);
  EXPECT_EQ(num_new(), num_all - 10);
}

// A map started from two views without depth, at true scale.
class WithoutDepth : public testing::Test {
 protected:
  WithoutDepth() {
    const features::View with_depth = features::test_view(world_, 0, {});
    ViewPair pair{features::test_view(world_, 0, {}, 0.3, false),
                  view_at(1, second_pose_),
                  second_pose_,
                  400.0 * core::Matrix6d::Identity(),
                  {},
                  {}};
    pair.matches = features::match_pair(pair.first.features->descriptors,
                                        pair.second.features->descriptors, {});
    for (const auto& match : pair.matches)
      pair.points_in_first.push_back(*features::point_in_camera(with_depth, match.first));
    num_points_ = pair.matches.size();
    map_ = apply(scene::MapVersion{}, start_map(scene::MapVersion{}, pair));
  }

  features::View view_at(int frame, const core::Rigid3& world_from_body) const {
    return features::test_view(world_, frame, world_from_body, 0.3, false);
  }

  // The view from there, which shows this share of the second keyframe's landmarks.
  scene::TrackedView tracked_at(const core::Rigid3& reference_from_frame,
                                double shown_ratio) const {
    scene::TrackedView tracked{view_at(2, second_pose_ * reference_from_frame), {}, {}};
    tracked.pose.reference_keyframe = core::KeyframeId(1);
    tracked.pose.reference_from_frame = reference_from_frame;
    for (std::size_t i = 0; i < static_cast<std::size_t>(shown_ratio * num_points_); ++i)
      tracked.landmarks.emplace_back(static_cast<int>(i), core::LandmarkId(i));
    return tracked;
  }

  features::TestWorld world_ = features::test_world(3);
  core::Rigid3 second_pose_{core::exp_so3({0.0, 0.05, 0.0}), {0.3, 0.0, 0.0}};
  std::size_t num_points_ = 0;
  scene::MapVersion map_;
  Config config_;
};

TEST_F(WithoutDepth, TwoViewsBecomeTwoKeyframesThatSeeTheSameLandmarks) {
  ASSERT_EQ(map_.keyframes.size(), 2U);
  ASSERT_EQ(map_.landmarks.size(), num_points_);
  EXPECT_GT(num_points_, 100U);
  EXPECT_FALSE(map_.keyframes[0].odometry);
  EXPECT_EQ(map_.keyframes[1].odometry->parent, core::KeyframeId(0));
  EXPECT_EQ(map_.keyframes[1].odometry->information(0, 0), 400.0);
  EXPECT_LT(core::log_r3so3(inverse(second_pose_) * map_.keyframes[1].world_from_body).norm(),
            1e-9);
  for (std::size_t i = 0; i < map_.landmarks.size(); ++i) {
    const scene::Landmark& landmark = map_.landmarks[i];
    ASSERT_EQ(landmark.observations.size(), 2U);
    for (const auto& seen : landmark.observations) {
      EXPECT_EQ(map_.at(seen.keyframe).slots[static_cast<std::size_t>(seen.slot)], landmark.id);
    }
    EXPECT_NEAR(landmark.range_m,
                (position_in_world(map_, landmark) - second_pose_.translation).norm(), 1e-9);
  }
}

TEST_F(WithoutDepth, AViewIsKeptWhenItMovedOrLostSightOfSomeLandmarks) {
  EXPECT_FALSE(is_worth_keeping(map_, tracked_at({}, 1.0), config_));
  config_.min_tracked = 0;
  EXPECT_FALSE(is_worth_keeping(map_, tracked_at({}, 0.55), config_));
  EXPECT_TRUE(is_worth_keeping(map_, tracked_at({}, 0.45), config_));
  const auto moved = [](double x) {
    return core::Rigid3{Eigen::Quaterniond::Identity(), {x, 0.0, 0.0}};
  };
  EXPECT_FALSE(is_worth_keeping(map_, tracked_at(moved(0.1), 1.0), config_));
  EXPECT_TRUE(is_worth_keeping(map_, tracked_at(moved(0.8), 1.0), config_));
}

TEST_F(WithoutDepth, AMapThatIsGivenUpBeginsAnewBesideItsOldKeyframes) {
  const scene::MapVersion given_up = apply(map_, give_up(map_));
  EXPECT_EQ(num_live(given_up.landmarks), 0U);
  EXPECT_EQ(num_live(given_up.keyframes), 2U);
  ViewPair pair{
      view_at(5, {}), view_at(6, second_pose_), second_pose_, core::Matrix6d::Identity(), {}, {}};
  pair.matches = {{0, 0, 0}, {1, 1, 0}};
  pair.points_in_first = {{0.0, 0.0, 2.0}, {0.5, 0.0, 2.0}};
  const scene::MapVersion anew = apply(given_up, start_map(given_up, pair));
  ASSERT_EQ(anew.keyframes.size(), 4U);
  EXPECT_FALSE(anew.keyframes[2].odometry) << "nobody knows where it stands to the old ones";
  EXPECT_EQ(anew.keyframes[3].odometry->parent, core::KeyframeId(2));
  EXPECT_EQ(num_live(anew.landmarks), 2U);
  const scene::Landmark& first = anew.landmarks[given_up.landmarks.size()];
  EXPECT_EQ(first.anchor, core::KeyframeId(2));
  EXPECT_EQ(anew.keyframes[2].slots[0], first.id);
  EXPECT_EQ(anew.keyframes[3].slots[0], first.id);
}

}  // namespace
}  // namespace samewhere::map
