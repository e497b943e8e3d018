#include <gtest/gtest.h>

#include <samewhere/twin/places.hpp>
#include <samewhere/twin/twin.hpp>

namespace samewhere::twin {
namespace {

using core::PlaceTruth;

constexpr int kWindow_frames = 150;  // 10 s, as in the protocol

bool has_loop(const core::PlaceTruthMatrix& places, int query) {
  for (int match = 0; match < query - kWindow_frames; ++match) {
    if (places.at(query, match) == PlaceTruth::kSame) return true;
  }
  return false;
}

void expect_only_the_end_has_loops(const core::PlaceTruthMatrix& places) {
  int num_loops = 0;
  for (int i = 0; i < places.num_frames; ++i) num_loops += static_cast<int>(has_loop(places, i));
  EXPECT_GT(num_loops, 70);
  EXPECT_LT(num_loops, 140);
  for (int i = places.num_frames - 60; i < places.num_frames; ++i) {
    EXPECT_TRUE(has_loop(places, i)) << i;
  }
  for (int i = 0; i < 400; ++i) EXPECT_FALSE(has_loop(places, i)) << i;
}

// Frames 20 to 60 and 300 to 340 walk along the two long sides.
void expect_opposite_corridors_differ(const core::PlaceTruthMatrix& places) {
  for (int query = 300; query < 340; ++query) {
    for (int match = 20; match < 60; ++match) {
      ASSERT_EQ(places.at(query, match), PlaceTruth::kDifferent) << query << ' ' << match;
      ASSERT_EQ(places.at(match, query), PlaceTruth::kDifferent) << query << ' ' << match;
    }
  }
}

TEST(OfficeLoopPlaces, TheWalkReturnsToItsStartAndOppositeCorridorsOnlyLookAlike) {
  const auto places = *open_twin("twin:office-loop?seed=3", {})->truth().places;
  for (int i = 0; i < places.num_frames; ++i) {
    ASSERT_EQ(places.at(i, i), PlaceTruth::kSame) << i;
    ASSERT_EQ(places.at(i, std::max(0, i - 1)), PlaceTruth::kSame) << i;
  }
  expect_only_the_end_has_loops(places);
  expect_opposite_corridors_differ(places);
}

core::Rigid3 looking_along_x(double x_m, double turned_rad) {
  Eigen::Matrix3d world_from_camera;
  world_from_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(turned_rad, Eigen::Vector3d::UnitZ()));
  return {turn * Eigen::Quaterniond(world_from_camera), {x_m, 0.0, 0.0}};
}

// A wide wall across x, seen from x = 0.
Rectangle wall_at(float x_m) {
  return {.corner_m = {x_m, 50.0F, -50.0F},
          .right = -Eigen::Vector3f::UnitY(),
          .up = Eigen::Vector3f::UnitZ(),
          .size_m = {100.0F, 100.0F}};
}

PlaceTruth places_of_two(const core::Rigid3& first, const core::Rigid3& second) {
  const core::PinholeRadtan camera{.width_px = 640,
                                   .height_px = 480,
                                   .fx_px = 525.0,
                                   .fy_px = 525.0,
                                   .cx_px = 319.5,
                                   .cy_px = 239.5};
  const Building building{.rectangles = {wall_at(2.0F)}};
  const RayScene rays(building.rectangles);
  return places_of({{0.0, first}, {1.0, second}}, building, rays, camera).at(0, 1);
}

TEST(Places, FollowFromTheSharedSurface) {
  // the picture is 62.7 degrees wide
  EXPECT_EQ(places_of_two(looking_along_x(0.0, 0.0), looking_along_x(0.0, 0.2)), PlaceTruth::kSame);
  EXPECT_EQ(places_of_two(looking_along_x(0.0, 0.0), looking_along_x(0.0, 0.85)),
            PlaceTruth::kNear);
  EXPECT_EQ(places_of_two(looking_along_x(0.0, 0.0), looking_along_x(0.0, 1.08)),
            PlaceTruth::kDifferent);
  // from twice as far, the near view is a quarter of the far one: seen whole one way only
  EXPECT_EQ(places_of_two(looking_along_x(0.0, 0.0), looking_along_x(-2.0, 0.0)),
            PlaceTruth::kNear);
}

TEST(Places, AWallBetweenHidesAPlace) {
  // b stands behind the wall that a looks at, and looks the same way onto another one
  const core::PinholeRadtan camera{.width_px = 640,
                                   .height_px = 480,
                                   .fx_px = 525.0,
                                   .fy_px = 525.0,
                                   .cx_px = 319.5,
                                   .cy_px = 239.5};
  const Building building{.rectangles = {wall_at(2.0F), wall_at(5.0F)}};
  const RayScene rays(building.rectangles);
  const auto places = places_of(
      {{0.0, looking_along_x(0.0, 0.0)}, {1.0, looking_along_x(2.5, 0.0)}}, building, rays, camera);
  EXPECT_EQ(places.at(0, 1), PlaceTruth::kDifferent);
}

}  // namespace
}  // namespace samewhere::twin
