#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/twin/building/plan.hpp>

namespace samewhere::twin {
namespace {

Space room(const Eigen::Vector2f& low_m, const Eigen::Vector2f& high_m, int unit = 0) {
  return {.name = "room", .unit = unit, .low_m = low_m, .high_m = high_m};
}

// Out of the wall, into the room.
Eigen::Vector2f out_of(const Wall& wall) {
  const Eigen::Vector2f right = (wall.to_m - wall.from_m).normalized();
  return {right.y(), -right.x()};
}

float area_m2(const std::vector<WallPiece>& walls) {
  float sum = 0.0F;
  for (const auto& piece : walls) sum += piece.length_m() * (piece.high_m - piece.low_m);
  return sum;
}

TEST(Plan, ARoomHasFourWallsThatLookIntoIt) {
  Plan plan;
  plan.add_unit(0, {});
  plan.add(room({1.0F, 2.0F}, {4.0F, 4.0F}));
  const auto walls = plan.walls_of(0);
  ASSERT_EQ(walls.size(), 4U);
  const Eigen::Vector2f middle_m(2.5F, 3.0F);
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const Wall& wall = walls[i].wall;
    EXPECT_GT(out_of(wall).dot(middle_m - wall.from_m), 0.5F) << "side " << i;
    EXPECT_TRUE(walls[i].is_whole());
    EXPECT_EQ(walls[i].side, static_cast<int>(i));
    EXPECT_EQ(wall.to_m, walls[(i + 1) % 4].wall.from_m) << "around the room in turn";
  }
}

TEST(Plan, ADoorwayLeavesALintelAndWallBothSides) {
  Plan plan;
  plan.add_unit(0, {});
  plan.add(room({0.0F, 0.0F}, {4.0F, 3.0F}));
  plan.add(room({0.0F, 3.15F}, {4.0F, 5.0F}));
  const int gap = plan.add(doorway({.name = "doorway"}, {1.0F, 3.075F}, false));
  std::vector<WallPiece> pieces;
  for (const auto& piece : plan.walls_of(0)) {
    if (piece.side == 2) pieces.push_back(piece);
  }
  ASSERT_EQ(pieces.size(), 3U);
  EXPECT_NEAR(pieces[0].length_m(), 0.55F, 1e-5F);
  EXPECT_TRUE(pieces[0].is_whole());
  EXPECT_NEAR(pieces[1].length_m(), 0.9F, 1e-5F);
  EXPECT_NEAR(pieces[1].low_m, 2.05F, 1e-5F);
  EXPECT_FALSE(pieces[1].is_whole());
  EXPECT_NEAR(pieces[2].length_m(), 2.55F, 1e-5F);
  EXPECT_EQ(plan.walls_of(gap).size(), 2U) << "the jambs";
}

TEST(Plan, SpacesMayTouchButNotOverlap) {
  Plan plan;
  plan.add_unit(0, {});
  plan.add_unit(0, {.num_quarter_turns = 2, .origin_m = {4.0F, 0.0F, 0.0F}});
  plan.add(room({0.0F, 0.0F}, {2.0F, 2.0F}));
  EXPECT_THROW(plan.add(room({1.9F, 0.0F}, {3.0F, 2.0F})), core::ContractError);
  EXPECT_NO_THROW(plan.add(room({2.0F, 0.0F}, {3.0F, 2.0F})));
  // in the world from (1, -2) to (4, 0)
  EXPECT_NO_THROW(plan.add(room({0.0F, 0.0F}, {3.0F, 2.0F}, 1)));
  EXPECT_THROW(plan.add(room({0.5F, -0.5F}, {2.5F, 0.0F}, 1)), core::ContractError);
}

// A room with a doorway, a step and a low neighbour, all with odd sizes.
void add_nook(Plan& plan, int unit, core::Random random) {
  const auto draw = [&](double low, double high) {
    return static_cast<float>(random.uniform(low, high));
  };
  const float width_m = draw(3.0, 5.0);
  const float depth_m = draw(2.0, 3.0);
  plan.add(room({0.0F, 0.0F}, {width_m, depth_m}, unit));
  plan.add(doorway({.name = "doorway", .unit = unit}, {draw(0.6, 2.0), depth_m + 0.075F}, false));
  plan.add(room({0.0F, depth_m + 0.15F}, {width_m, depth_m + 2.0F}, unit));
  Space step = room({width_m, draw(0.1, 0.9)}, {width_m + 0.28F, depth_m}, unit);
  step.floor_m = 0.5F / 3.0F;
  step.ceiling_m = draw(2.0, 2.5);
  plan.add(step);
}

TEST(Plan, LookAlikesHaveTheSameWallsToTheLastBit) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    core::Random random(seed);
    Plan plan;
    for (int unit = 0; unit < 4; ++unit) {
      plan.add_unit(0, {.num_quarter_turns = unit,
                        .origin_m = {static_cast<float>(random.uniform(-3.0, 3.0)),
                                     static_cast<float>(random.uniform(-3.0, 3.0)),
                                     4.0F * static_cast<float>(unit)}});
      add_nook(plan, unit, core::Random(seed + 1000));
    }
    for (int space = 0; space < 4; ++space) {
      const auto first = plan.walls_of(space);
      for (int unit = 1; unit < 4; ++unit) {
        const auto other = plan.walls_of(4 * unit + space);
        ASSERT_EQ(first.size(), other.size()) << "seed " << seed;
        for (std::size_t i = 0; i < first.size(); ++i) {
          ASSERT_EQ(first[i].wall.from_m, other[i].wall.from_m) << "seed " << seed;
          ASSERT_EQ(first[i].wall.to_m, other[i].wall.to_m) << "seed " << seed;
          ASSERT_EQ(first[i].low_m, other[i].low_m) << "seed " << seed;
          ASSERT_EQ(first[i].high_m, other[i].high_m) << "seed " << seed;
        }
      }
    }
  }
}

TEST(Plan, AreasStandWhereTheirUnitDoes) {
  Plan plan;
  plan.add_unit(0, {.num_quarter_turns = 1, .origin_m = {10.0F, 0.0F, 3.0F}});
  plan.add(room({1.0F, 2.0F}, {4.0F, 3.0F}));
  const Area area = plan.areas().front();
  EXPECT_LT((area.low_m - Eigen::Vector3f(7.0F, 1.0F, 3.0F)).norm(), 1e-5F);
  EXPECT_LT((area.high_m - Eigen::Vector3f(8.0F, 4.0F, 5.6F)).norm(), 1e-5F);
}

TEST(UStair, RisesAStoreyInEighteenSteps) {
  Plan plan;
  plan.add_unit(0, {});
  add_u_stair(plan, {.name = "stairs"}, {0.0F, 0.0F});
  EXPECT_EQ(plan.spaces().size(), 17U) << "the eighteenth is the next floor";
  float risers_m2 = 0.0F;
  for (int i = 0; i < 17; ++i) {
    for (const auto& piece : plan.walls_of(i)) {
      const bool is_riser = piece.low_m == piece.wall.floor_m && !piece.is_whole();
      if (is_riser) risers_m2 += area_m2({piece});
    }
  }
  // 16 of them between steps and half-landing: the first and the last belong to the floors
  EXPECT_NEAR(risers_m2, 16.0F * u_stair::kFlightWidth_m / 6.0F, 1e-3F);
}

TEST(UStair, StacksAndItsWayUpEndsWhereTheNextBegins) {
  Plan plan;
  plan.add_unit(0, {});
  for (int floor = 0; floor < 3; ++floor) {
    Space like{.name = "stairs", .floor = floor};
    like.floor_m = u_stair::kStorey_m * static_cast<float>(floor);
    EXPECT_NO_THROW(add_u_stair(plan, like, {1.0F, -2.0F}));
  }
  const auto first = way_up({1.0F, -2.0F}, 0.0F);
  const auto second = way_up({1.0F, -2.0F}, u_stair::kStorey_m);
  EXPECT_FLOAT_EQ(first.back().z(), second.front().z());
  EXPECT_FLOAT_EQ(first.back().y(), second.front().y());
  EXPECT_GT(second.front().x(), first.back().x()) << "up on the right";
}

}  // namespace
}  // namespace samewhere::twin
