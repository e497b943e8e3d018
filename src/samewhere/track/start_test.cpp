#include <gmock/gmock.h>

#include <samewhere/core/median.hpp>
#include <samewhere/features/test_world.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/track/starter.hpp>

namespace samewhere::track {
namespace {

using core::Rigid3;

// A wall three metres ahead, with points all over it.
features::TestWorld wall(std::uint64_t seed) {
  features::TestWorld world = features::test_world(seed, 900);
  core::Random random(seed);
  for (auto& point : world.points) {
    point = {random.uniform(-2.5, 2.5), random.uniform(-1.8, 1.8), 0.0};
    point.z() = 3.0 + 0.2 * point.x() - 0.1 * point.y();
  }
  return world;
}

features::View view_without_depth(const features::TestWorld& world, int frame,
                                  const Rigid3& world_from_body) {
  return features::test_view(world, frame, world_from_body, 0.5, false);
}

// What the view from `first_from_second` starts against the one at the origin.
Result<Start, NoStart> started(const features::TestWorld& world, const Rigid3& first_from_second,
                               const StartSettings& settings = {}) {
  return try_start(view_without_depth(world, 0, {}),
                   view_without_depth(world, 1, first_from_second), settings);
}

StartSettings from_fundamental() { return {.start = {.model = StartModel::kFundamental}}; }

Rigid3 sideways(std::uint64_t seed) {
  core::Random random(seed);
  const Eigen::Vector3d turn_rad(random.uniform(-0.05, 0.05), random.uniform(-0.1, 0.1),
                                 random.uniform(-0.05, 0.05));
  return {core::exp_so3(turn_rad), {0.3, random.uniform(-0.1, 0.1), random.uniform(-0.2, 0.2)}};
}

double direction_error_rad(const Rigid3& a, const Rigid3& b) {
  return std::atan2(a.translation.cross(b.translation).norm(), a.translation.dot(b.translation));
}

void expect_start(const features::TestWorld& world, const Rigid3& truth, std::uint64_t seed,
                  const StartSettings& settings = {}) {
  const auto start = started(world, truth, settings);
  ASSERT_TRUE(start) << "seed " << seed << ": " << start.error().reason;
  EXPECT_LT(core::angle_rad(start->first_from_second.rotation.conjugate() * truth.rotation), 0.01)
      << "seed " << seed;
  EXPECT_LT(direction_error_rad(start->first_from_second, truth), 0.12) << "seed " << seed;
  std::vector<double> depths;
  for (const auto& point : start->points_in_first) depths.push_back(point.z());
  EXPECT_NEAR(core::median(depths).value_or(0.0), 1.0, 1e-9) << "the scale is free";
}

TEST(Start, OfARoomFindsTheMotion) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    expect_start(features::test_world(seed), sideways(seed), seed);
  }
}

TEST(Start, PointsLieWhereTheyAreUpToTheScale) {
  const features::TestWorld world = features::test_world(3);
  const auto first = features::test_view(world, 0, {}, 0.5);
  const auto start = started(world, sideways(3));
  ASSERT_TRUE(start);
  EXPECT_FALSE(start->is_planar);
  std::vector<double> ratios;
  for (std::size_t i = 0; i < start->matches.size(); ++i) {
    const auto truth = features::point_in_camera(first, start->matches[i].first);
    ratios.push_back(truth->z() / start->points_in_first[i].z());
  }
  std::sort(ratios.begin(), ratios.end());
  EXPECT_GT(ratios.size(), 100U);
  EXPECT_LT(ratios[ratios.size() * 9 / 10] / ratios[ratios.size() / 10], 1.3);
}

// An edge of odometry that knows nothing gives way to any loop behind it.
TEST(Start, ItsInformationTellsHowFarItIsOff) {
  std::vector<double> squared;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const features::TestWorld world = features::test_world(seed);
    const Rigid3 truth = sideways(seed);
    const auto start = started(world, truth);
    ASSERT_TRUE(start) << "seed " << seed;
    const auto first = features::test_view(world, 0, {}, 0.5);
    std::vector<double> scales;
    for (std::size_t i = 0; i < start->matches.size(); ++i)
      scales.push_back(features::point_in_camera(first, start->matches[i].first)->z() /
                       start->points_in_first[i].z());
    const Rigid3& found = start->first_from_second;
    core::Vector6d error;
    error << found.translation - truth.translation / *core::median(scales),
        core::log_so3(truth.rotation.conjugate() * found.rotation);
    squared.push_back(error.dot(start->information * error));
    EXPECT_GT(start->information(0, 0), 1e3) << "within some centimetres, seed " << seed;
  }
  EXPECT_LT(*core::median(squared), 12.0);
  EXPECT_GT(*core::median(squared), 0.1);
}

TEST(Start, OfAWallNeverTellsAWrongMotion) {
  int num_started = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Rigid3 truth = sideways(seed);
    const auto start = started(wall(seed), truth);
    if (!start) {
      EXPECT_EQ(start.error().refusal, StartRefusal::kAmbiguous) << "seed " << seed;
      continue;
    }
    ++num_started;
    EXPECT_TRUE(start->is_planar) << "seed " << seed;
    EXPECT_LT(direction_error_rad(start->first_from_second, truth), 0.2) << "seed " << seed;
  }
  EXPECT_GT(num_started, 5) << "else this says nothing";
}

TEST(Start, ARotationIsRefused) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const auto start =
        started(features::test_world(seed), {core::exp_so3({0.05, 0.15, 0.03}), {0.0, 0.0, 0.0}});
    ASSERT_FALSE(start) << "seed " << seed;
    EXPECT_EQ(start.error().refusal, StartRefusal::kLowParallax)
        << "seed " << seed << ": " << start.error().reason;
  }
}

TEST(Start, AStepOfAFewMillimetresIsRefused) {
  const auto start = started(features::test_world(2), {core::exp_so3({0, 0.05, 0}), {0.01, 0, 0}});
  ASSERT_FALSE(start);
  EXPECT_EQ(start.error().refusal, StartRefusal::kLowParallax) << start.error().reason;
}

TEST(Start, ViewsOfDifferentThingsHaveFewMatches) {
  const auto start = try_start(view_without_depth(features::test_world(1), 0, {}),
                               view_without_depth(features::test_world(2), 1, {}), {});
  ASSERT_FALSE(start);
  EXPECT_EQ(start.error().refusal, StartRefusal::kFewMatches);
  EXPECT_LT(start.error().num_matches, 20);
}

TEST(Start, WrongMatchesDoNotBendIt) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    features::TestWorld world = features::test_world(seed);
    const Rigid3 truth = sideways(seed);
    const auto first = view_without_depth(world, 0, {});
    core::Random random(seed);
    for (auto& point : world.points) {  // three of ten things have moved
      if (random.uniform() < 0.3) point += Eigen::Vector3d(random.uniform(-1, 1), 0.3, 0.2);
    }
    const auto start = try_start(first, view_without_depth(world, 1, truth), {});
    ASSERT_TRUE(start) << "seed " << seed << ": " << start.error().reason;
    EXPECT_LT(direction_error_rad(start->first_from_second, truth), 0.15) << "seed " << seed;
  }
}

TEST(StartFromFundamental, OfARoomFindsTheMotion) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    expect_start(features::test_world(seed), sideways(seed), seed, from_fundamental());
  }
}

TEST(StartFromFundamental, WrongMatchesDoNotBendIt) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    features::TestWorld world = features::test_world(seed);
    const Rigid3 truth = sideways(seed);
    const auto first = view_without_depth(world, 0, {});
    core::Random random(seed);
    for (auto& point : world.points) {  // three of ten things have moved
      if (random.uniform() < 0.3) point += Eigen::Vector3d(random.uniform(-1, 1), 0.3, 0.2);
    }
    const auto start = try_start(first, view_without_depth(world, 1, truth), from_fundamental());
    ASSERT_TRUE(start) << "seed " << seed << ": " << start.error().reason;
    EXPECT_LT(direction_error_rad(start->first_from_second, truth), 0.15) << "seed " << seed;
  }
}

// Seven or more points of a plane fit infinitely many fundamental matrices.
TEST(StartFromFundamental, AWallIsRefused) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto start = started(wall(seed), sideways(seed), from_fundamental());
    ASSERT_FALSE(start) << "seed " << seed;
    EXPECT_EQ(start.error().refusal, StartRefusal::kDegenerate)
        << "seed " << seed << ": " << start.error().reason;
  }
}

// Things before a wall, from nearly none to many: the share of the wall at which F is trusted is
// for the threshold to say, but a motion that is told is the true one.
TEST(StartFromFundamental, AWallWithThingsBeforeItNeverTellsAWrongMotion) {
  int num_started = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    features::TestWorld world = wall(seed);
    core::Random random(seed);
    const double things_ratio = 0.01 * static_cast<double>(seed);
    for (auto& point : world.points) {
      if (random.uniform() < things_ratio) point *= random.uniform(0.4, 0.9);
    }
    const Rigid3 truth = sideways(seed);
    const auto start = started(world, truth, from_fundamental());
    if (!start) continue;
    ++num_started;
    EXPECT_LT(direction_error_rad(start->first_from_second, truth), 0.2) << "seed " << seed;
    EXPECT_LT(core::angle_rad(start->first_from_second.rotation.conjugate() * truth.rotation), 0.05)
        << "seed " << seed;
  }
  EXPECT_GT(num_started, 10);
}

TEST(StartFromFundamental, ARotationIsRefused) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto start =
        started(features::test_world(seed), {core::exp_so3({0.05, 0.15, 0.03}), {0.0, 0.0, 0.0}},
                from_fundamental());
    ASSERT_FALSE(start) << "seed " << seed;
    EXPECT_EQ(start.error().refusal, StartRefusal::kDegenerate)
        << "seed " << seed << ": " << start.error().reason;
  }
}

TEST(StartFromFundamental, AStepOfAFewMillimetresIsRefused) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    EXPECT_FALSE(started(features::test_world(seed), {core::exp_so3({0, 0.05, 0}), {0.01, 0, 0}},
                         from_fundamental()))
        << "seed " << seed;
  }
}

TEST(StartFromFundamental, TheSameViewsGiveTheSameBits) {
  const auto first = started(features::test_world(6), sideways(6), from_fundamental());
  const auto second = started(features::test_world(6), sideways(6), from_fundamental());
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->points_in_first, second->points_in_first);
  EXPECT_EQ(first->first_from_second.translation, second->first_from_second.translation);
}

TEST(Starter, WaitsForParallaxAndThenStartsFromTheFirstView) {
  const features::TestWorld world = features::test_world(4);
  Starter starter{StartSettings{}};
  EXPECT_FALSE(starter.offer(view_without_depth(world, 0, {}))) << "nothing to compare with";
  EXPECT_EQ(starter.last_refusal(), "");
  EXPECT_FALSE(starter.offer(view_without_depth(world, 1, {core::exp_so3({0, 0.1, 0}), {0, 0, 0}})))
      << "a rotation";
  EXPECT_THAT(starter.last_refusal(), testing::HasSubstr("median parallax 0.0"));
  const auto started = starter.offer(view_without_depth(world, 2, sideways(4)));
  ASSERT_TRUE(started);
  EXPECT_EQ(started->first.frame, core::FrameId(0));
  ASSERT_EQ(started->between.size(), 1U);
  EXPECT_EQ(started->between[0].frame, core::FrameId(1));
}

TEST(Starter, AFirstViewThatWaitedTooLongGivesUpItsPlace) {
  const features::TestWorld world = features::test_world(4);
  Starter starter{StartSettings{.start = {.max_waiting_frames = 2}}};
  for (int frame = 0; frame < 4; ++frame)
    EXPECT_FALSE(starter.offer(view_without_depth(world, frame, {}))) << "standing still";
  const auto started = starter.offer(view_without_depth(world, 4, sideways(4)));
  ASSERT_TRUE(started);
  EXPECT_EQ(started->first.frame, core::FrameId(3));
}

TEST(Starter, AViewOfSomethingElseBecomesTheFirst) {
  const features::TestWorld world = features::test_world(4);
  Starter starter{StartSettings{}};
  EXPECT_FALSE(starter.offer(view_without_depth(features::test_world(5), 0, {})));
  EXPECT_FALSE(starter.offer(view_without_depth(world, 1, {})));
  const auto started = starter.offer(view_without_depth(world, 2, sideways(4)));
  ASSERT_TRUE(started);
  EXPECT_EQ(started->first.frame, core::FrameId(1));
}

}  // namespace
}  // namespace samewhere::track
