#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/twin/building/angles.hpp>
#include <samewhere/twin/building/test_room.hpp>
#include <samewhere/twin/front/walkthrough.hpp>
#include <samewhere/twin/motion/motion.hpp>
#include <samewhere/twin/motion/stray.hpp>

namespace samewhere::twin {
namespace {

constexpr double kLeft_rad = 0.5 * kPi;  // of a view along x

Stray stray_where(double most_m, double room_m) {
  return {.most_m = most_m, .room_m = [=](const Eigen::Vector3d&, double) { return room_m; }};
}

// There and back.
Route there_and_back(Carrier carrier = Carrier::kWalker) {
  return {.steps = {WalkTo{{30.0, 0.0, 0.0}}, TurnTo{kPi}, WalkTo{{0.0, 0.0, 0.0}}},
          .carrier = carrier};
}

double largest_difference_m(const Motion& a, const Motion& b) {
  double largest_m = 0.0;
  for (double t = 0.0; t < a.duration_s(); t += 0.1)
    largest_m = std::max(largest_m, (a.floor_position_m(t) - b.floor_position_m(t)).norm());
  return largest_m;
}

TEST(RoomIn, AWallIsKeptAnElbowAway) {
  const TestRoom room(Colour::Constant(0.5F));
  const RayScene rays(room.building.rectangles);
  EXPECT_NEAR(room_in(rays, {0, 0.8, 0}, kLeft_rad, 1.0), 0.85, 0.06);
  EXPECT_NEAR(room_in(rays, {0, 1.5, 0}, kLeft_rad, 1.0), 0.15, 0.06);
  EXPECT_EQ(room_in(rays, {0, 1.9, 0}, kLeft_rad, 1.0), 0.0);
  EXPECT_EQ(room_in(rays, {0, 0.5, 0}, -kLeft_rad, 1.0), 1.0);
}

TEST(RoomIn, ATableTopAHookAndAnEdgeAreInTheWay) {
  const Eigen::Vector3f x = Eigen::Vector3f::UnitX();
  const Eigen::Vector3f y = Eigen::Vector3f::UnitY();
  const Eigen::Vector3f z = Eigen::Vector3f::UnitZ();
  TestRoom table(Colour::Constant(0.5F));
  table.add({-1, 1, 0.72F}, x, y, {2, 1}, {});  // thin, between two heights that are felt at
  EXPECT_NEAR(room_in(RayScene(table.building.rectangles), {0, 0, 0}, kLeft_rad, 1.0), 0.65, 0.06);
  TestRoom board(Colour::Constant(0.5F));
  board.add({-1, 1, 1.2F}, x, z, {2, 0.5F}, {});
  EXPECT_NEAR(room_in(RayScene(board.building.rectangles), {0, 0, 0}, kLeft_rad, 1.0), 0.65, 0.06);
  TestRoom landing(Colour::Constant(0.5F));
  landing.building.rectangles[TestRoom::kFloor].size_m.y() = 3.0F;  // ends at y = 1
  EXPECT_NEAR(room_in(RayScene(landing.building.rectangles), {0, 0, 0}, kLeft_rad, 1.0), 0.65,
              0.06);
}

TEST(Stray, WithoutOffsetTheMotionIsUnchanged) {
  EXPECT_EQ(largest_difference_m(Motion(there_and_back(), 3), Motion(there_and_back(), 3, {})),
            0.0);
  EXPECT_EQ(largest_difference_m(Motion(there_and_back(Carrier::kRobot), 3),
                                 Motion(there_and_back(Carrier::kRobot), 3, stray_where(1.0, 1.0))),
            0.0);
}

TEST(Stray, GoesAsFarAsThereIsRoomAndNoFurther) {
  for (const double room_m : {0.0, 0.3, 0.8}) {
    double largest_m = 0.0;
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      largest_m =
          std::max(largest_m,
                   largest_difference_m(Motion(there_and_back(), seed),
                                        Motion(there_and_back(), seed, stray_where(1.0, room_m))));
    }
    EXPECT_LE(largest_m, room_m + 1e-9);
    EXPECT_GE(largest_m, 0.9 * room_m);
  }
  EXPECT_LE(largest_difference_m(Motion(there_and_back(), 1),
                                 Motion(there_and_back(), 1, stray_where(0.5, 9.0))),
            0.5 + 1e-9);
}

TEST(Stray, OneTurnsOnTheSpotWhereOneWouldHaveTurned) {
  const Motion straight(there_and_back(), 2);
  const Motion astray(there_and_back(), 2, stray_where(1.0, 1.0));
  int num_turning = 0;
  for (double t = 0.0; t < straight.duration_s(); t += 0.05) {
    const double turn_rad = std::abs(straight.heading_rad(t + 0.05) - straight.heading_rad(t));
    if (turn_rad < 0.01) continue;
    ++num_turning;
    EXPECT_LT((straight.floor_position_m(t) - astray.floor_position_m(t)).norm(), 1e-3);
  }
  EXPECT_GT(num_turning, 20);
}

TEST(Stray, TheCameraMovesSmoothlyAndIsTurnedByNoMoreThanPromised) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Motion straight(there_and_back(), seed);
    const Motion astray(there_and_back(), seed, stray_where(1.0, 1.0));
    for (double t = 0.0; t < astray.duration_s(); t += 0.0317) {
      const Eigen::Vector3d moved_m =
          astray.world_from_body(t + 1e-4).translation - astray.world_from_body(t).translation;
      ASSERT_LT((moved_m / 1e-4 - astray.velocity_m_s(t)).norm(), 1e-2) << "seed " << seed;
      ASSERT_LT(astray.velocity_m_s(t).norm(), 2.2) << "seed " << seed;
      const double turn_rad =
          straight.world_from_body(t).rotation.angularDistance(astray.world_from_body(t).rotation);
      ASSERT_LT(turn_rad, 22.0 * kDegree_rad) << "seed " << seed;
      const double raised_m =
          astray.world_from_body(t).translation.z() - straight.world_from_body(t).translation.z();
      ASSERT_LE(std::abs(raised_m), 0.25 + 1e-9) << "seed " << seed;
    }
  }
}

TEST(Stray, NeedsTheFreeRoomBesideThePath) {
  EXPECT_THROW(Motion(there_and_back(), 1, {.most_m = 1.0, .room_m = nullptr}),
               core::ContractError);
}

class StrayThrough : public testing::TestWithParam<std::string> {};

// Nothing between two neighbouring moments of the camera, nor near it.
TEST_P(StrayThrough, NoWallAndNoThingIsWalkedThrough) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Walkthrough walk({.preset = GetParam(), .seed = seed, .stray_m = 1.0}, {});
    double farthest_m = 0.0;
    const Motion straight = Walkthrough({.preset = GetParam(), .seed = seed}, {}).motion();
    for (double t = 0.0; t < walk.motion().duration_s(); t += 0.1) {
      const Eigen::Vector3d here_m = walk.motion().world_from_body(t).translation;
      farthest_m = std::max(
          farthest_m, (walk.motion().floor_position_m(t) - straight.floor_position_m(t)).norm());
      for (int k = 0; k < 16; ++k) {
        const double heading_rad = k * kPi / 8.0;
        const Eigen::Vector3d arm_m(0.25 * std::cos(heading_rad), 0.25 * std::sin(heading_rad), 0);
        for (const auto& visit : walk.visits()) {
          ASSERT_FALSE(visit.rays->is_blocked({here_m.cast<float>(), arm_m.cast<float>()}))
              << "seed " << seed << ", " << t << " s";
        }
      }
    }
    EXPECT_GT(farthest_m, 0.3) << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Presets, StrayThrough,
                         testing::Values("office-loop", "twin-corridors", "hotel", "no-return",
                                         "mirror", "second-visit"),
                         [](const auto& preset) {
                           std::string name = preset.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace samewhere::twin
