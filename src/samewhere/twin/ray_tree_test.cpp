#include <gtest/gtest.h>

#include <samewhere/core/random.hpp>
#include <samewhere/twin/office_loop.hpp>
#include <samewhere/twin/ray_tree.hpp>

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
    Rectangle r{.axis = static_cast<int>(random.index(3))};
    r.plane_m = middle[r.axis];
    const Eigen::Vector2f half(static_cast<float>(random.uniform(0.05, 1.5)),
                               static_cast<float>(random.uniform(0.05, 1.5)));
    r.low_m = r.on_plane(middle) - half;
    r.high_m = r.on_plane(middle) + half;
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

TEST(RayTree, FindsWhatTryingEveryRectangleFinds) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    core::Random random(seed);
    const auto rectangles = random_rectangles(random, 1 + static_cast<int>(random.index(200)));
    const RayTree tree(rectangles);
    for (int i = 0; i < 200; ++i) {
      const Ray ray{random_point(random, {6.0F, 6.0F, 3.0F}),
                    random_point(random, {1.0F, 1.0F, 1.0F})};
      const auto expected = nearest_of_all(ray, rectangles);
      const auto found = tree.first_hit(ray);
      ASSERT_EQ(found.has_value(), expected.has_value()) << "seed " << seed;
      if (!found) continue;
      ASSERT_EQ(found->rectangle, expected->rectangle) << "seed " << seed;
      ASSERT_NEAR(found->reach, expected->reach, 1e-4F * expected->reach) << "seed " << seed;
    }
  }
}

TEST(RayTree, AWayIsBlockedByWhatStandsBeforeItsEnd) {
  Rectangle wall{.axis = 0, .plane_m = 2.0F, .low_m = {-1.0F, -1.0F}, .high_m = {1.0F, 1.0F}};
  const RayTree tree({wall});
  const Eigen::Vector3f origin = Eigen::Vector3f::Zero();
  EXPECT_TRUE(tree.is_blocked({origin, {3.0F, 0.0F, 0.0F}}));
  EXPECT_FALSE(tree.is_blocked({origin, {1.5F, 0.0F, 0.0F}}));
  EXPECT_FALSE(tree.is_blocked({origin, {2.0F, 0.0F, 0.0F}}));  // ends on it
  EXPECT_FALSE(tree.is_blocked({origin, {-3.0F, 0.0F, 0.0F}}));
  EXPECT_FALSE(tree.is_blocked({origin, {3.0F, 2.0F, 0.0F}}));
}

TEST(OfficeLoop, NoRayEscapes) {
  const auto rectangles = office_loop_surfaces(3, 0.5);
  const RayTree tree(rectangles);
  core::Random random(7);
  for (int i = 0; i < 20000; ++i) {
    const Ray ray{{static_cast<float>(random.uniform(-6.0, 6.0)), -4.0F, 1.5F},
                  random_point(random, {1.0F, 1.0F, 1.0F})};
    ASSERT_TRUE(tree.first_hit(ray).has_value()) << "ray " << i;
  }
}

}  // namespace
}  // namespace samewhere::twin
