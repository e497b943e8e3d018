#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include <samewhere/features/test_world.hpp>
#include <samewhere/verify/test_corridor.hpp>

namespace samewhere::verify {
namespace {

TEST(MeasureOdometry, ALoopThatAgreesWithOdometryHasNoCorrection) {
  const auto evidence =
      TestDrift(corridor(10)).odometry(claim(9, 0, {Eigen::Quaterniond::Identity(), {0, 0, 9}}));
  EXPECT_NEAR(evidence.correction_m, 0.0, 1e-9);
  EXPECT_NEAR(evidence.mahalanobis_squared, 0.0, 1e-9);
}

TEST(MeasureOdometry, TheSameCorrectionCountsMoreAfterAShortChain) {
  const core::Rigid3 beside{Eigen::Quaterniond::Identity(), {0.0, 0.0, 0.0}};
  const auto after = [&](int steps) {
    core::Rigid3 match_from_query = beside;
    match_from_query.translation.z() = steps - 1.0;  // one metre short of what odometry says
    return TestDrift(corridor(steps + 1)).odometry(claim(steps, 0, match_from_query));
  };
  EXPECT_NEAR(after(5).correction_m, 1.0, 1e-9);
  EXPECT_GT(after(5).mahalanobis_squared, Config{}.max_odometry_chi_square);
  EXPECT_LT(after(60).mahalanobis_squared, after(5).mahalanobis_squared / 5.0);
}

TEST(MeasureOdometry, WithoutDepthTheGateIsWiderAlongTheChainOnly) {
  const features::View without_depth =
      features::test_view(features::test_world(1, 20), 0, {}, 0.0, false);
  const auto squared = [&](const features::View& view, const Eigen::Vector3d& error) {
    const core::Rigid3 seen{Eigen::Quaterniond::Identity(), error + Eigen::Vector3d(0, 0, 20)};
    return TestDrift(corridor(21, view), {}, {.creep = 0.02})
        .odometry(claim(20, 0, seen))
        .mahalanobis_squared;
  };
  const Eigen::Vector3d along(0.0, 0.0, 2.0);
  const Eigen::Vector3d aside(2.0, 0.0, 0.0);
  EXPECT_LT(squared(without_depth, along), 0.8 * squared({}, along));
  EXPECT_NEAR(squared(without_depth, aside), squared({}, aside), 1e-6);
}

// Once around a square of ten steps a side, each a metre in truth, of a camera without depth with
// the same scale drift at every keyframe.
scene::MapVersion square_seen_without_depth(double creep) {
  const features::View view = features::test_view(features::test_world(1, 20), 0, {}, 0.0, false);
  scene::Edit edit;
  core::Rigid3 pose;
  for (int i = 0; i <= 40; ++i) {
    core::Rigid3 step;
    step.translation = {0.0, 0.0, std::exp(-creep * (i - 0.5))};
    if (i % 10 == 0)
      step.rotation = Eigen::AngleAxisd(std::numbers::pi / 2.0, Eigen::Vector3d::UnitY());
    scene::Keyframe keyframe;
    keyframe.id = core::KeyframeId(static_cast<std::uint64_t>(i));
    keyframe.view = view;
    keyframe.slots.resize(static_cast<std::size_t>(view.features->size()));
    if (i > 0) {
      pose = pose * step;
      keyframe.odometry = {core::KeyframeId(static_cast<std::uint64_t>(i - 1)), step,
                           1e4 * core::Matrix6d::Identity()};
    }
    keyframe.world_from_body = pose;
    edit.keyframes.push_back(keyframe);
  }
  return apply(scene::MapVersion{}, edit);
}

TEST(MeasureOdometry, WithoutDepthTheScaleDriftOfTheLoopIsTakenOut) {
  const double creep = 0.02;
  const scene::MapVersion map = square_seen_without_depth(creep);
  const auto squared = [&](const Eigen::Vector3d& error, double log_scale) {
    scene::LoopEdge loop = claim(40, 0, {Eigen::Quaterniond::Identity(), error});
    loop.log_scale = log_scale;
    return TestDrift(map).odometry(loop).mahalanobis_squared;
  };
  const double limit = Config{}.max_odometry_chi_square;
  const Eigen::Vector3d aside(2.0, 0.0, 0.0);
  EXPECT_LT(squared(Eigen::Vector3d::Zero(), 40 * creep), 1.0) << "back where it began";
  EXPECT_GT(squared(Eigen::Vector3d::Zero(), 0.0), limit) << "no scale drift, and yet far away";
  EXPECT_GT(squared(aside, 40 * creep), limit) << "another corridor, seen at the same scale";
}

TEST(MeasureOdometry, WithoutACommonOriginTheGateIsOpen) {
  scene::MapVersion map = corridor(3);
  scene::Edit edit;
  edit.keyframes.resize(1);
  edit.keyframes[0].id = core::KeyframeId(3);
  map = apply(map, edit);
  const auto evidence = TestDrift(map).odometry(claim(3, 0, {}));
  EXPECT_EQ(evidence.mahalanobis_squared, 0.0);
}

// A corridor with a loop from keyframe 20 to keyframe 2.
scene::MapVersion corridor_with_loop() {
  scene::MapVersion map = corridor(80);
  scene::Edit edit;
  edit.loops.push_back(claim(20, 2, {}));
  return apply(map, edit);
}

// A claim that would move this keyframe sideways by so much.
scene::LoopEdge sideways(const scene::MapVersion& map, int query, double metres) {
  const scene::LoopEdge ends = claim(query, 3, {});
  core::Rigid3 match_from_query =
      inverse(world_from_body(map, ends.match)) * world_from_body(map, ends.query);
  match_from_query.translation.x() += metres;
  return claim(query, 3, match_from_query);
}

TEST(MeasureOdometry, TellsAPlaceFromALookAlikeAfterAShortChainOnly) {
  const auto after = [&](int steps) {
    return TestDrift(corridor(steps + 1))
        .odometry(claim(steps, 0, {Eigen::Quaterniond::Identity(), {0, 0, 1.0 * steps}}));
  };
  ASSERT_TRUE(after(3).look_alike_gain && after(60).look_alike_gain);
  EXPECT_GT(*after(3).look_alike_gain, Config{}.min_look_alike_gain);
  EXPECT_LT(*after(60).look_alike_gain, Config{}.min_look_alike_gain);
  EXPECT_GT(*after(60).sigma_m, 2.0 * *after(3).sigma_m);
  EXPECT_FALSE(after(60).look_alike_gain_with_loops) << "there are none";
}

TEST(MeasureOdometry, EarlierLoopsTakeDriftOutOfTheGate) {
  scene::MapVersion map = corridor(40);
  const auto agreed = [](int query, int match) {
    return claim(query, match, {Eigen::Quaterniond::Identity(), {0, 0, 1.0 * (query - match)}});
  };
  const auto before = TestDrift(map).odometry(agreed(31, 1));
  scene::Edit edit;
  edit.loops.push_back(agreed(31, 1));
  map = apply(map, edit);
  const auto after = TestDrift(map).odometry(agreed(31, 1));
  ASSERT_TRUE(after.look_alike_gain_with_loops && after.mahalanobis_squared_with_loops);
  EXPECT_EQ(after.look_alike_gain, before.look_alike_gain) << "odometry alone knows no loop";
  EXPECT_LT(*before.look_alike_gain, Config{}.min_look_alike_gain);
  EXPECT_GT(*after.look_alike_gain_with_loops, Config{}.min_look_alike_gain);
  EXPECT_NEAR(*after.mahalanobis_squared_with_loops, 0.0, 1e-9);
  EXPECT_LT(*after.sigma_m, 0.5 * *before.sigma_m);
  // what lies between both ends of the loop was not measured again
  const auto halfway = TestDrift(map).odometry(agreed(31, 16));
  EXPECT_LT(*halfway.look_alike_gain_with_loops, *after.look_alike_gain_with_loops);
}

TEST(MeasureOdometry, LoopsJoinWhatOdometryDoesNot) {
  scene::MapVersion map = corridor(3);
  scene::Edit edit;
  edit.keyframes.resize(1);
  edit.keyframes[0].id = core::KeyframeId(3);
  map = apply(map, edit);
  EXPECT_FALSE(TestDrift(map).odometry(claim(3, 0, {})).look_alike_gain);
  scene::Edit joined;
  joined.loops.push_back(claim(3, 1, {Eigen::Quaterniond::Identity(), {0, 0, -1}}));
  joined.loops.back().information = loop_information({});
  map = apply(map, joined);
  EXPECT_TRUE(TestDrift(map).odometry(claim(3, 0, {})).look_alike_gain_with_loops);
}

TEST(MeasureCompetingPlace, TwoClaimsShowTwoPlacesIfOdometryKeepsTheirMatchesApart) {
  const scene::MapVersion map = corridor(40);
  const core::Rigid3 here;
  const auto places = [&](const scene::LoopEdge& one, const scene::LoopEdge& other) {
    return TestDrift(map).competing_place(one, other);
  };
  const auto apart = places(claim(39, 2, here), claim(39, 8, here));
  ASSERT_TRUE(apart) << "it cannot be at both ends of six metres";
  EXPECT_NEAR(apart->apart_m, 6.0, 1e-9);
  EXPECT_TRUE(places(claim(39, 8, here), claim(39, 2, here))) << "whichever is asked first";
  EXPECT_FALSE(
      places(claim(39, 2, {Eigen::Quaterniond::Identity(), {0, 0, 6}}), claim(39, 8, here)))
      << "one place, seen from two";
}

TEST(MeasureCompetingLoop, TheFirstLoopHasNone) {
  const scene::MapVersion map = corridor_with_loop();
  EXPECT_FALSE(TestDrift(map).competing_loop(sideways(map, 19, 1.8)));
  EXPECT_TRUE(TestDrift(map).competing_loop(sideways(map, 20, 1.8)));
}

TEST(MeasureCompetingLoop, ItsChiSquareShrinksWithTheDriftSinceTheLastLoop) {
  const scene::MapVersion map = corridor_with_loop();
  const auto after = [&](int keyframes, double metres) {
    return *TestDrift(map).competing_loop(sideways(map, 20 + keyframes, metres));
  };
  EXPECT_NEAR(after(2, 1.8).apart_m, 1.8, 1e-9);
  EXPECT_NEAR(after(2, 1.8).apart_rad, 0.0, 1e-9);
  EXPECT_GT(after(2, 1.8).mahalanobis_squared, Config{}.max_competing_chi_square);
  EXPECT_LT(after(2, 0.05).mahalanobis_squared, 1.0) << "one place, and a better pose";
  EXPECT_LT(after(55, 1.8).mahalanobis_squared, after(2, 1.8).mahalanobis_squared / 5.0);
}

// A corridor in which loops have moved keyframes from the first of them on sideways by so much.
scene::MapVersion corridor_moved_by(const std::vector<int>& queries, double metres) {
  scene::MapVersion map = corridor(80);
  scene::Edit edit;
  for (const int query : queries) {
    edit.loops.push_back(sideways(map, query, metres));
    edit.loops.back().cause = core::CandidateId(static_cast<std::uint64_t>(query));
  }
  for (std::size_t i = static_cast<std::size_t>(queries.front()); i < map.keyframes.size(); ++i)
    edit.pose_changes.push_back(
        {core::KeyframeId(i), {Eigen::Quaterniond::Identity(), {metres, 0.0, 0.0}}});
  return apply(map, edit);
}

TEST(MeasureCompetingLoop, TheGainFavoursTheClaimThatAgreesWithOdometry) {
  const scene::MapVersion map = corridor_moved_by({20, 22}, 4.0);
  const auto back = TestDrift(map).competing_loop(sideways(map, 24, -4.0));
  ASSERT_TRUE(back && back->gain);
  EXPECT_EQ(back->first_loop, core::CandidateId(20)) << "the second agrees with the first";
  EXPECT_GT(*back->gain, 9.0);
  const auto further = TestDrift(map).competing_loop(sideways(map, 24, 4.0));
  ASSERT_TRUE(further && further->gain);
  EXPECT_LT(*further->gain, -9.0);
}

TEST(MeasureCompetingLoop, AnEarlierLoopThatAgreesWithTheClaimIsTheBaseOfTheGain) {
  scene::MapVersion map = corridor_moved_by({20, 22}, 1.8);
  const auto without = TestDrift(map).competing_loop(sideways(map, 24, -1.8));
  ASSERT_TRUE(without && without->gain);
  scene::Edit edit;
  edit.loops.push_back(claim(18, 2, {Eigen::Quaterniond::Identity(), {0, 0, 16}}));
  map = apply(map, edit);
  const auto with = TestDrift(map).competing_loop(sideways(map, 24, -1.8));
  ASSERT_TRUE(with && with->gain);
  EXPECT_EQ(with->first_loop, core::CandidateId(20));
  EXPECT_GT(*with->gain, 3.0 * std::abs(*without->gain))
      << "the covariance of two keyframes is smaller than that of twenty";
}

// After a long chain odometry allows both, but the loop fits the false ones before it better.
TEST(MeasureCompetingLoop, ALoopThatFitsTheContradictingOnesBetterIsNoBase) {
  const scene::MapVersion map =
      corridor_moved_by({20, 25, 30, 35, 40, 45, 50, 55, 60, 65, 70}, 4.0);
  const auto competing = TestDrift(map).competing_loop(sideways(map, 72, -4.0));
  ASSERT_TRUE(competing && competing->gain);
  EXPECT_EQ(competing->first_loop, core::CandidateId(20));
}

// The small covariance of a short chain is no evidence against a loop over a long one.
TEST(MeasureCompetingLoop, AShortChainIsNoEvidenceByItself) {
  scene::MapVersion map = corridor(80);
  scene::Edit edit;
  edit.loops.push_back(claim(60, 3, {Eigen::Quaterniond::Identity(), {0.0, 0.0, 57.0}}));
  map = apply(map, edit);
  const auto competing = TestDrift(map).competing_loop(
      claim(64, 55, {Eigen::Quaterniond::Identity(), {0.0, 0.0, 9.6}}));
  ASSERT_TRUE(competing && competing->gain);
  EXPECT_LT(*competing->gain, -10.0);
}

TEST(MeasureCompetingLoop, WithTheLastLoopOrBeyondTheGateThereIsNoGain) {
  const scene::MapVersion map = corridor_moved_by({20, 22}, 1.8);
  EXPECT_FALSE(TestDrift(map).competing_loop(sideways(map, 24, 0.1))->gain);
  const auto beyond = TestDrift(map).competing_loop(sideways(map, 24, 8.0));
  EXPECT_GT(beyond->mahalanobis_squared, Config{}.max_competing_chi_square);
  EXPECT_FALSE(beyond->gain);
}

TEST(MeasureCompetingLoop, WithoutDepthThereIsNoGain) {
  scene::MapVersion map =
      corridor(40, features::test_view(features::test_world(1, 20), 0, core::Rigid3{}, 0.0, false));
  scene::Edit edit;
  edit.loops.push_back(sideways(map, 20, 0.0));
  map = apply(map, edit);
  const auto competing = TestDrift(map).competing_loop(sideways(map, 22, 1.8));
  ASSERT_TRUE(competing);
  EXPECT_GT(competing->mahalanobis_squared, Config{}.max_competing_chi_square);
  EXPECT_FALSE(competing->gain);
}

}  // namespace
}  // namespace samewhere::verify
