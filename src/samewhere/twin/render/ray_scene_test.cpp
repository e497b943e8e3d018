#include <gtest/gtest.h>

#include <samewhere/core/random.hpp>
#include <samewhere/twin/render/ray_scene.hpp>

namespace samewhere::twin {
namespace {

Eigen::Vector3f random_point(core::Random& random, const Eigen::Vector3f& half_size_m) {
  Eigen::Vector3f point;
  for (int i = 0; i < 3; ++i) {
    point[i] = half_size_m[i] * static_cast<float>(random.uniform(-1.0, 1.0));
  }
  return point;
}

std::vector<Rectangle> random_rectangles(core::Random& random, int count) {
  std::vector<Rectangle> rectangles;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3f middle = random_point(random, {5.0F, 5.0F, 2.0F});
    const Eigen::Quaternionf turn =
        Eigen::Quaternionf(Eigen::Vector4f(random_point(random, {1, 1, 1}).homogeneous()))
            .normalized();
    Rectangle r{.right = turn * Eigen::Vector3f::UnitX(), .up = turn * Eigen::Vector3f::UnitY()};
    r.size_m = {static_cast<float>(random.uniform(0.1, 3.0)),
                static_cast<float>(random.uniform(0.1, 3.0))};
    r.corner_m = middle - 0.5F * r.size_m.x() * r.right - 0.5F * r.size_m.y() * r.up;
    rectangles.push_back(r);
  }
  return rectangles;
}

// The slow way: every rectangle.
std::optional<Hit> nearest_of_all(const Ray& ray, const std::vector<Rectangle>& rectangles) {
  std::optional<Hit> nearest;
  for (std::size_t i = 0; i < rectangles.size(); ++i) {
    const auto reach = reach_of(ray, rectangles[i]);
    if (reach && (!nearest || *reach < nearest->reach)) nearest = Hit{static_cast<int>(i), *reach};
  }
  return nearest;
}

TEST(RayScene, FindsWhatTryingEveryRectangleFinds) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    core::Random random(seed);
    const auto rectangles = random_rectangles(random, 1 + static_cast<int>(random.index(200)));
    const RayScene rays(rectangles);
    for (int i = 0; i < 200; ++i) {
      const Ray ray{random_point(random, {6.0F, 6.0F, 3.0F}),
                    random_point(random, {1.0F, 1.0F, 1.0F})};
      const auto expected = nearest_of_all(ray, rectangles);
      const auto found = rays.first_hit(ray);
      ASSERT_EQ(found.has_value(), expected.has_value()) << "seed " << seed;
      if (!found) continue;
      ASSERT_EQ(found->rectangle, expected->rectangle) << "seed " << seed;
      ASSERT_NEAR(found->reach, expected->reach, 1e-4F * expected->reach) << "seed " << seed;
    }
  }
}

TEST(RayScene, ManyRaysAtOnceMeetWhatEachMeetsAlone) {
  core::Random random(5);
  const auto rectangles = random_rectangles(random, 150);
  const RayScene rays(rectangles);
  const Eigen::Vector3f origin(0.3F, -0.2F, 0.1F);
  std::vector<Eigen::Vector3f> directions;
  for (int i = 0; i < 1003; ++i) directions.push_back(random_point(random, {1.0F, 1.0F, 1.0F}));
  std::vector<Hit> hits(directions.size());
  rays.first_hits(origin, directions, hits);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const auto alone = rays.first_hit({origin, directions[i]});
    ASSERT_EQ(hits[i].rectangle, alone ? alone->rectangle : -1) << "ray " << i;
    ASSERT_EQ(hits[i].reach, alone ? alone->reach : 0.0F) << "ray " << i;
  }
}

TEST(RayScene, AWayIsBlockedByWhatStandsBeforeItsEnd) {
  const std::vector<Rectangle> walls{{.corner_m = {2.0F, -1.0F, -1.0F},
                                      .right = Eigen::Vector3f::UnitY(),
                                      .up = Eigen::Vector3f::UnitZ(),
                                      .size_m = {2.0F, 2.0F}}};
  const RayScene rays(walls);
  const Eigen::Vector3f origin = Eigen::Vector3f::Zero();
  EXPECT_TRUE(rays.is_blocked({origin, {3.0F, 0.0F, 0.0F}}));
  EXPECT_FALSE(rays.is_blocked({origin, {1.5F, 0.0F, 0.0F}}));
  EXPECT_FALSE(rays.is_blocked({origin, {2.0F, 0.0F, 0.0F}}));  // ends on it
  EXPECT_FALSE(rays.is_blocked({origin, {-3.0F, 0.0F, 0.0F}}));
  EXPECT_FALSE(rays.is_blocked({origin, {3.0F, 2.0F, 0.0F}}));
}

}  // namespace
}  // namespace samewhere::twin
