#include <memory>
#include <numbers>

#include <gtest/gtest.h>

#include <samewhere/twin/building/test_rooms.hpp>
#include <samewhere/twin/truth/unique_objects.hpp>

namespace samewhere::twin {
namespace {

using test::kCamera;
using test::looking;

constexpr double kPlate_x_m = 3.99;

// A room with a plate of 20 cm on its far wall.
Building room_with_plate() {
  Building building;
  test::add_room(building, {}, 0.0F);
  test::add_plate(building, 0, "door plate 7", 0.2F);
  return building;
}

std::vector<ShownObject> shown_in(const Building& building, const core::Rigid3& pose) {
  const RayScene rays(building.rectangles);
  return UniqueObjects({{&building, &rays}}).shown_to(kCamera, pose, 0);
}

// Where the plate is `size_px` wide.
core::Rigid3 facing_the_plate(double size_px) {
  return looking({kPlate_x_m - 0.2 * 525.0 / size_px, 1.5, 1.3}, 0.0);
}

TEST(UniqueObjects, APlateCountsFromTwentyPixels) {
  // at 19 px the camera stands outside of the room: its near wall must not hide the plate
  Building building = room_with_plate();
  building.rectangles.erase(building.rectangles.begin());
  EXPECT_TRUE(shown_in(building, facing_the_plate(19.0)).empty());
  const auto shown = shown_in(building, facing_the_plate(21.0));
  ASSERT_EQ(shown.size(), 1U);
  EXPECT_NEAR(shown[0].size_px, 21.0F, 0.05F);
}

TEST(UniqueObjects, TheShorterSideCounts) {
  // seen at 75 degrees from straight ahead, 40 px become about 10
  const double angle_rad = 75.0 / 180.0 * std::numbers::pi;
  const double distance_m = 0.2 * 525.0 / 40.0;
  Building building = room_with_plate();
  building.rectangles.erase(building.rectangles.begin() + 2);  // a wall in the way
  const core::Rigid3 aslant = looking(
      {kPlate_x_m - distance_m * std::cos(angle_rad), 1.5 - distance_m * std::sin(angle_rad), 1.3},
      angle_rad);
  EXPECT_TRUE(shown_in(building, aslant).empty());
  EXPECT_EQ(shown_in(building, facing_the_plate(40.0)).size(), 1U);
}

TEST(UniqueObjects, WhatIsHiddenIsNotShown) {
  Building building = room_with_plate();
  ASSERT_EQ(shown_in(building, facing_the_plate(40.0)).size(), 1U);
  // a post before its right edge
  building.rectangles.push_back({.corner_m = {3.5F, 1.45F, 0.0F},
                                 .right = -Eigen::Vector3f::UnitY(),
                                 .up = Eigen::Vector3f::UnitZ(),
                                 .size_m = {0.1F, 2.6F}});
  EXPECT_TRUE(shown_in(building, facing_the_plate(40.0)).empty());
}

TEST(UniqueObjects, WhatIsPartOfItDoesNotHideIt) {
  Building building = room_with_plate();
  Rectangle print = building.rectangles.back();
  print.corner_m.x() -= 0.1F;
  print.size_m *= 0.5F;
  building.rectangles.push_back(print);
  EXPECT_EQ(shown_in(building, facing_the_plate(40.0)).size(), 1U);
}

TEST(UniqueObjects, ABackOrAnEdgeOfThePictureShowsNothing) {
  const Building building = room_with_plate();
  const core::Rigid3 facing = facing_the_plate(40.0);
  EXPECT_TRUE(shown_in(building, looking(facing.translation, 0.52)).empty()) << "cut by the edge";
  EXPECT_EQ(shown_in(building, looking(facing.translation, 0.4)).size(), 1U);
  EXPECT_TRUE(shown_in(building, looking(facing.translation, std::numbers::pi)).empty());

  Building bare = room_with_plate();
  bare.rectangles.erase(bare.rectangles.begin() + 1);  // nothing behind the plate
  EXPECT_TRUE(shown_in(bare, looking({6.0, 1.5, 1.3}, std::numbers::pi)).empty()) << "its back";
}

TEST(UniqueObjects, OnlyUniqueOnesCount) {
  Building building = room_with_plate();
  building.objects[0].is_unique = false;
  EXPECT_TRUE(shown_in(building, facing_the_plate(40.0)).empty());
}

std::optional<std::string> shared_by_two_visits(const Building& first, const Building& second) {
  const RayScene rays_of_first(first.rectangles);
  const RayScene rays_of_second(second.rectangles);
  const UniqueObjects objects({{&first, &rays_of_first}, {&second, &rays_of_second}});
  const auto id = best_shared(objects.shown_to(kCamera, facing_the_plate(40.0), 0),
                              objects.shown_to(kCamera, facing_the_plate(35.0), 1));
  return id ? std::optional(objects.name(*id)) : std::nullopt;
}

TEST(UniqueObjects, AreRecognisedOnASecondVisitUnlessExchanged) {
  const Building first = room_with_plate();
  EXPECT_EQ(shared_by_two_visits(first, first), "door plate 7");

  Building moved_chairs = first;  // other indices, the same things
  moved_chairs.objects.insert(moved_chairs.objects.begin(), {.name = "chair", .unit = 0});
  moved_chairs.rectangles.back().object = 1;
  EXPECT_EQ(shared_by_two_visits(first, moved_chairs), "door plate 7");

  Building renamed = first;
  renamed.objects[0].name = "door plate 8";
  EXPECT_EQ(shared_by_two_visits(first, renamed), std::nullopt);
  Building new_print = first;
  new_print.rectangles.back().material.own_pattern_seed = 5;
  EXPECT_EQ(shared_by_two_visits(first, new_print), std::nullopt);
  Building moved = first;
  moved.rectangles.back().corner_m.z() += 0.2F;
  EXPECT_EQ(shared_by_two_visits(first, moved), std::nullopt);
}

TEST(BestShared, IsTheOneWhoseSmallerShowingIsTheLargest) {
  EXPECT_EQ(best_shared({{1, 90}, {2, 40}, {5, 30}}, {{1, 21}, {2, 35}, {6, 99}}), 2);
  EXPECT_EQ(best_shared({{1, 90}}, {{2, 35}}), std::nullopt);
  EXPECT_EQ(best_shared({}, {{2, 35}}), std::nullopt);
  EXPECT_EQ(best_shared({{1, 30}, {2, 30}}, {{1, 30}, {2, 30}}), 1) << "the first of equals";
}

}  // namespace
}  // namespace samewhere::twin
