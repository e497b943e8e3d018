#include <gtest/gtest.h>

#include <samewhere/twin/building/shapes.hpp>
#include <samewhere/twin/building/test_room.hpp>
#include <samewhere/twin/render/moving_things.hpp>

namespace samewhere::twin {
namespace {

// Upright on the floor of the test room, 1 m aside of the lamp.
std::vector<Rectangle> things_in_room(const Post& post, const Bar& bar) {
  std::vector<Rectangle> rectangles;
  Shapes shapes(rectangles,
                stand_of({1.0F, 0.0F, 0.0F}, Eigen::Vector3f::UnitX(), Eigen::Vector3f::UnitZ()));
  const Material paint{.finish = Finish::kPaint};
  shapes.add_post(post, paint);
  shapes.add_bar(bar, paint);
  return rectangles;
}

constexpr int kPostSides = 12;
constexpr int kBarSides = 8;

TEST(MovingThings, WhatIsRoundShowsNoSeamsBetweenItsSides) {
  const TestRoom room(Colour::Constant(0.5F));
  const RayScene rays(room.building.rectangles);
  const Light light(room.building.rectangles, rays, kNumThreads);
  const auto rectangles =
      things_in_room({.low_m = 0.5F, .half_m = {0.2F, 0.12F}, .num_sides = kPostSides},
                     {.from_m = {0.5F, 0.5F, 0.0F},
                      .to_m = {0.5F, 0.9F, 0.2F},
                      .radius_m = 0.05F,
                      .num_sides = kBarSides});
  ASSERT_EQ(rectangles.size(), static_cast<std::size_t>(kPostSides + kBarSides));
  MovingThings things(rectangles, light);
  for (int i = 0; i < kPostSides + kBarSides; ++i) {
    const bool is_last = i == kPostSides - 1 || i == kPostSides + kBarSides - 1;
    if (is_last) continue;
    const Rectangle& here = things.rectangle(i);
    const Rectangle& next = things.rectangle(i + 1);
    EXPECT_LT((here.at({here.size_m.x(), 0.0F}) - next.corner_m).norm(), 1e-4F) << "side " << i;
    for (const float up_ratio : {0.0F, 0.4F, 1.0F}) {
      const Colour on_right =
          things.light_at(i, here.size_m.cwiseProduct(Eigen::Vector2f(1, up_ratio)));
      const Colour on_left = things.light_at(i + 1, {0.0F, up_ratio * next.size_m.y()});
      EXPECT_NEAR(on_right[1], on_left[1], 0.01F * on_left[1]) << "side " << i;
    }
  }
}

// What turns towards the lamp has more light than what turns away.
TEST(MovingThings, WhatIsRoundIsBrighterTowardsTheLamp) {
  const TestRoom room(Colour::Constant(0.3F));
  const RayScene rays(room.building.rectangles);
  const Light light(room.building.rectangles, rays, kNumThreads);
  const auto rectangles = things_in_room(
      {.low_m = 0.5F, .half_m = {0.15F, 0.15F}, .num_sides = kPostSides}, {.num_sides = kBarSides});
  MovingThings things(rectangles, light);
  float towards = 0.0F;
  float away = 0.0F;
  for (int i = 0; i < kPostSides; ++i) {
    const Rectangle& r = things.rectangle(i);
    (r.normal().x() < 0.0F ? towards : away) += things.light_at(i, 0.5F * r.size_m)[1];
  }
  EXPECT_GT(towards, 1.3F * away);
}

}  // namespace
}  // namespace samewhere::twin
