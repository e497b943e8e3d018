#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include <samewhere/twin/building/furnisher.hpp>
#include <samewhere/twin/building/test_furniture.hpp>

namespace samewhere::twin {
namespace {

using test::furnish;
using test::kWall;
using test::twins;

TEST(Furnisher, EveryRectangleHasTwoUnitSidesAtRightAngles) {
  const Building building = twins(0.5);
  ASSERT_GT(building.rectangles.size(), 1000U);
  for (const auto& r : building.rectangles) {
    EXPECT_NEAR(r.right.norm(), 1.0F, 1e-5F);
    EXPECT_NEAR(r.up.norm(), 1.0F, 1e-5F);
    EXPECT_NEAR(r.right.dot(r.up), 0.0F, 1e-5F);
    EXPECT_GT(r.size_m.minCoeff(), 0.0F);
  }
}

TEST(Furnisher, ThingsOnAWallLookIntoTheRoom) {
  Building building;
  building.units = {Unit{}};
  Furnisher f(building, 0, {});
  f.add_wall(kWall, 0.0F, 2.6F, WallFinish::kPlaster);
  f.add_notice_board({kWall, 2.0F});
  f.add_framed_poster({kWall, 4.0F});
  for (const auto& r : building.rectangles) {
    EXPECT_GE(-r.normal().y(), -1e-5F) << "looks into the wall";
    EXPECT_LE(r.corner_m.y(), 2.0F + 1e-5F);
  }
}

TEST(Furnisher, FreeStandingThingsAreClosed) {
  // seen from all around, a closed surface shows as much towards one side as towards the other
  Building building;
  building.units = {Unit{}};
  Furnisher f(building, 0, {});
  f.add_chair({{1.0F, 2.0F, 0.0F}, 0.8F});
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float whole_m2 = 0.0F;
  for (const auto& r : building.rectangles) {
    sum += r.size_m.prod() * r.normal();
    whole_m2 += r.size_m.prod();
  }
  EXPECT_LT(sum.head<2>().norm(), 0.03F * whole_m2);
}

TEST(Furnisher, WhatStandsBeforeAWallTakesNoMoreRoomThanPromised) {
  using Add = void (Furnisher::*)(const Place&);
  struct Thing {
    Add add;
    Eigen::Vector2f most_m;  // width, depth
  };
  const Thing things[] = {{&Furnisher::add_coat_rack, {1.00F, 0.24F}},
                          {&Furnisher::add_leaflets, {0.74F, 0.05F}},
                          {&Furnisher::add_low_shelf, {0.90F, 0.31F}},
                          {&Furnisher::add_crates, {0.52F, 0.39F}}};
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    for (const Thing& thing : things) {
      Building building;
      building.units = {Unit{}};
      Furnisher f(building, 0, {.own_seed = seed, .similarity = 0.0});
      (f.*thing.add)({kWall, 4.0F});
      Eigen::AlignedBox3f box;
      for (const auto& r : building.rectangles) {
        box.extend(r.corner_m);
        box.extend(r.at(r.size_m));
      }
      EXPECT_GT(building.rectangles.size(), 10U);
      EXPECT_LE(box.sizes().x(), thing.most_m.x() + 1e-4F) << "seed " << seed;
      EXPECT_LE(box.sizes().y(), thing.most_m.y() + 1e-4F) << "seed " << seed;
      EXPECT_GE(box.min().z(), -1e-4F) << "seed " << seed;
    }
  }
}

TEST(Furnisher, AChairTurnsWithItsHeading) {
  constexpr float kQuarter_rad = 0.5F * std::numbers::pi_v<float>;
  const auto chair = [](float heading_rad) {
    Building building;
    building.units = {Unit{}};
    Furnisher(building, 0, {}).add_chair({{0.0F, 0.0F, 0.0F}, heading_rad});
    return building.rectangles;
  };
  const auto ahead = chair(0.0F);
  const auto left = chair(kQuarter_rad);
  ASSERT_EQ(ahead.size(), left.size());
  for (std::size_t i = 0; i < ahead.size(); ++i) {
    const Eigen::Vector3f& at = ahead[i].corner_m;
    EXPECT_LT((left[i].corner_m - Eigen::Vector3f(-at.y(), at.x(), at.z())).norm(), 1e-5F);
  }
}

TEST(Furnisher, ADoorIsAsLargeAsADoor) {
  Building building;
  building.units = {Unit{}};
  Furnisher(building, 0, {}).add_door({kWall, 4.0F}, 12);
  Eigen::AlignedBox3f box;
  for (const auto& r : building.rectangles) {
    box.extend(r.corner_m);
    box.extend(r.at(r.size_m));
  }
  constexpr float kLeastFrame_m = 0.04F;
  constexpr float kMostFrame_m = 0.07F;
  EXPECT_GT(box.sizes().z(), 2.05F + kLeastFrame_m - 1e-3F);
  EXPECT_LT(box.sizes().z(), 2.05F + kMostFrame_m + 1e-3F);
  EXPECT_GT(box.min().x(), -0.45F - kMostFrame_m - 1e-3F);
  EXPECT_LT(box.min().x(), -0.45F - kLeastFrame_m + 1e-3F);
  EXPECT_NEAR(box.max().x(), 0.765F, 1e-3F);  // the plate
}

TEST(Objects, ThatAreUniqueHaveANameOfTheirOwn) {
  const Building building = twins(0.8);
  std::set<std::string> names;
  int num_unique = 0;
  for (const auto& object : building.objects) {
    if (!object.is_unique) continue;
    ++num_unique;
    if (object.name.starts_with("floor number")) continue;  // both twins are on the third floor
    EXPECT_TRUE(names.insert(object.name).second) << object.name;
  }
  EXPECT_GE(num_unique, 4);
  for (const auto& r : building.rectangles) {
    EXPECT_LT(r.object, static_cast<int>(building.objects.size()));
  }
}

}  // namespace
}  // namespace samewhere::twin
