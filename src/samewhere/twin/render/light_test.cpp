#include <numbers>

#include <gtest/gtest.h>

#include <samewhere/twin/building/test_room.hpp>
#include <samewhere/twin/render/light.hpp>
#include <samewhere/twin/render/texture.hpp>

namespace samewhere::twin {
namespace {

// Of a small lamp on a point of the floor right below it.
float expected_below(const Rectangle& lamp) {
  constexpr float kRange_m = 7.0F;
  const float height_m = TestRoom::kLamp_m;
  const float window = 1.0F - height_m * height_m / (kRange_m * kRange_m);
  const float sent = mean_reflectance(lamp.material)[0] * lamp.material.radiance;
  return sent * lamp.size_m.prod() / std::numbers::pi_v<float> / (height_m * height_m) * window;
}

TEST(Light, InABlackRoomItFallsWithTheSquareOfTheDistance) {
  const TestRoom room(Colour::Zero());
  const RayScene rays(room.building.rectangles);
  const Light light(room.building.rectangles, rays, kNumThreads);
  const float below = light.at(TestRoom::kFloor, {3.0F, 2.0F})[0];
  EXPECT_NEAR(below, expected_below(room.building.rectangles.back()), 0.05F * below);
  const float aside = light.at(TestRoom::kFloor, {5.0F, 2.0F})[0];
  const float cosine = TestRoom::kLamp_m / std::hypot(TestRoom::kLamp_m, 2.0F);
  const float window = (49.0F - 8.88F - 4.0F) / (49.0F - 8.88F);
  EXPECT_NEAR(aside / below, std::pow(cosine, 4.0F) * window, 0.03F);
}

TEST(Light, BrightWallsSendItOn) {
  const TestRoom dark(Colour::Zero());
  const TestRoom bright(Colour::Constant(0.7F));
  const RayScene rays(dark.building.rectangles);
  const Light direct(dark.building.rectangles, rays, kNumThreads);
  const Light all(bright.building.rectangles, rays, kNumThreads);
  // the ceiling sees no lamp, only what the floor and the walls send up
  EXPECT_EQ(direct.at(1, {1.0F, 1.0F})[0], 0.0F);
  EXPECT_GT(all.at(1, {1.0F, 1.0F})[0], 0.1F * all.at(TestRoom::kFloor, {3.0F, 2.0F})[0]);
}

// The floor is wide enough for the coarse grid: it must still find the edge of the shadow.
TEST(Light, ABoardInTheWayCastsItsShadow) {
  TestRoom room(Colour::Zero());
  const Material paint = room.building.rectangles.front().material;
  room.add({-1.0F, -0.5F, 1.0F}, Eigen::Vector3f::UnitX(), Eigen::Vector3f::UnitY(), {1.0F, 1.0F},
           paint);
  room.add({-1.0F, 0.5F, 0.99F}, Eigen::Vector3f::UnitX(), -Eigen::Vector3f::UnitY(), {1.0F, 1.0F},
           paint);
  const RayScene rays(room.building.rectangles);
  const Light light(room.building.rectangles, rays, kNumThreads);
  EXPECT_LT(light.at(TestRoom::kFloor, {2.3F, 2.0F})[0], 1e-3F);
  EXPECT_GT(light.at(TestRoom::kFloor, {3.5F, 2.0F})[0], 0.05F);
  const float edge = light.at(TestRoom::kFloor, {3.0F, 2.0F})[0];
  EXPECT_GT(edge, 1e-3F);
  EXPECT_LT(edge, 0.9F * light.at(TestRoom::kFloor, {3.5F, 2.0F})[0]) << "soft";
}

// Rays that happen to meet the brightly lit sign must not paint its colour onto the walls.
TEST(Light, ASmallSignUnderALampLeavesNoBlotchesOfItsColour) {
  TestRoom room(Colour::Constant(0.6F));
  const Colour green(0.1F, 0.6F, 0.1F);
  const Material paint{.finish = Finish::kPaint, .colour = green, .second = green};
  const Eigen::Vector3f x = Eigen::Vector3f::UnitX();
  const Eigen::Vector3f z = Eigen::Vector3f::UnitZ();
  room.add({-0.18F, -0.01F, 2.72F}, x, z, {0.36F, 0.16F}, paint);
  room.add({0.18F, 0.01F, 2.72F}, -x, z, {0.36F, 0.16F}, paint);
  const RayScene rays(room.building.rectangles);
  const Light light(room.building.rectangles, rays, kNumThreads);
  constexpr int kRoomWall = 2;
  constexpr float kStep_m = 0.1F;
  for (float up_m = 0.3F; up_m < 2.7F; up_m += kStep_m) {
    for (float right_m = 0.3F; right_m < 5.7F; right_m += kStep_m) {
      const Colour here = light.at(kRoomWall, {right_m, up_m});
      const Colour next = light.at(kRoomWall, {right_m + kStep_m, up_m});
      const float hue = here[1] / here[2];
      EXPECT_NEAR(hue, 1.0F, 0.12F) << "hue at " << right_m << ", " << up_m;
      EXPECT_NEAR(next[1] / next[2], hue, 0.04F) << "change at " << right_m << ", " << up_m;
    }
  }
}

TEST(Light, AThingInTheRoomIsLitLikeTheSurfaceItLiesOn) {
  const TestRoom room(Colour::Constant(0.5F));
  const RayScene rays(room.building.rectangles);
  const Light light(room.building.rectangles, rays, kNumThreads);
  for (const Eigen::Vector2f& at : {Eigen::Vector2f(3.0F, 2.0F), Eigen::Vector2f(4.3F, 1.2F)}) {
    const float on_floor = light.at(TestRoom::kFloor, at)[1];
    const float on_thing =
        light.falling_on({{at.x() - 3.0F, at.y() - 2.0F, 0.01F}, Eigen::Vector3f::UnitZ()})[1];
    EXPECT_NEAR(on_thing, on_floor, 0.12F * on_floor);
  }
}

}  // namespace
}  // namespace samewhere::twin
