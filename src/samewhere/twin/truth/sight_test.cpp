#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <samewhere/core/random.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/twin/building/test_rooms.hpp>
#include <samewhere/twin/front/camera.hpp>
#include <samewhere/twin/truth/sight.hpp>

namespace samewhere::twin {
namespace {

using test::kCamera;
using test::looking;

// A wide wall across x, seen from x = 0.
Rectangle wall_at(float x_m) {
  return {.corner_m = {x_m, 50.0F, -50.0F},
          .right = -Eigen::Vector3f::UnitY(),
          .up = Eigen::Vector3f::UnitZ(),
          .size_m = {100.0F, 100.0F}};
}

struct Overlaps {
  double first_by_second = 0.0;
  double second_by_first = 0.0;
};

Overlaps overlaps_of(const std::vector<Rectangle>& rectangles, const core::Rigid3& first,
                     const core::Rigid3& second) {
  const Building building{.rectangles = rectangles};
  const RayScene rays(building.rectangles);
  const Eye eye(kCamera);
  const Sight a = eye.look(first, {&building, &rays});
  const Sight b = eye.look(second, {&building, &rays});
  return {eye.overlap(a, b), eye.overlap(b, a)};
}

TEST(Overlap, IsTheSharedPartOfTheSurface) {
  const auto turned_by = [](double angle_rad) {
    return overlaps_of({wall_at(2.0F)}, looking({0, 0, 0}, 0.0), looking({0, 0, 0}, angle_rad))
        .first_by_second;
  };
  EXPECT_EQ(turned_by(0.0), 1.0);
  // the columns of rays end at tan(31.3 degrees) = .61: turned by .2 it sees to tan(.546 - .2)
  EXPECT_NEAR(turned_by(0.2), 0.5 + 0.5 * std::tan(0.5465 - 0.2) / std::tan(0.5465), 0.03);
  EXPECT_EQ(turned_by(1.2), 0.0);

  // from twice as far the near view is a quarter of the far one
  const Overlaps far =
      overlaps_of({wall_at(2.0F)}, looking({0, 0, 0}, 0.0), looking({-2, 0, 0}, 0.0));
  EXPECT_EQ(far.first_by_second, 1.0);
  EXPECT_NEAR(far.second_by_first, 0.25, 0.02);
}

TEST(Overlap, AWallBetweenHidesAPlace) {
  // the second stands behind the wall that the first looks at, and looks onto another one
  const Overlaps hidden = overlaps_of({wall_at(2.0F), wall_at(5.0F)}, looking({0, 0, 0}, 0.0),
                                      looking({2.5, 0, 0}, 0.0));
  EXPECT_EQ(hidden.first_by_second, 0.0);
  EXPECT_EQ(hidden.second_by_first, 0.0);
}

TEST(Overlap, TheTwoSidesOfAThinWallAreNotOneSurface) {
  Rectangle back = wall_at(2.05F);
  back.corner_m.y() = -50.0F;
  back.right = Eigen::Vector3f::UnitY();
  const Overlaps sides = overlaps_of({wall_at(2.0F), back}, looking({0, 0, 0}, 0.0),
                                     looking({4, 0, 0}, std::numbers::pi));
  EXPECT_EQ(sides.first_by_second, 0.0);
  EXPECT_EQ(sides.second_by_first, 0.0);
}

TEST(Overlap, DepthAgreesWithinFiveCentimetresAndFourPercent) {
  // two visits: the same wall, moved; the picture is full of it both times
  const auto overlap_when_moved_by = [](float moved_m) {
    const Building before{.rectangles = {wall_at(2.0F)}};
    const Building after{.rectangles = {wall_at(2.0F + moved_m)}};
    const RayScene rays_before(before.rectangles);
    const RayScene rays_after(after.rectangles);
    const Eye eye(kCamera);
    return eye.overlap(eye.look(looking({0, 0, 0}, 0.0), {&before, &rays_before}),
                       eye.look(looking({0, 0, 0}, 0.0), {&after, &rays_after}));
  };
  EXPECT_EQ(overlap_when_moved_by(0.0F), 1.0);
  EXPECT_EQ(overlap_when_moved_by(0.12F), 1.0);  // 0.05 + 0.04 * 2 = 0.13
  EXPECT_EQ(overlap_when_moved_by(0.14F), 0.0);
}

TEST(Overlap, TheDarkSharesNothing) {
  const Building building{.rectangles = {wall_at(2.0F)}};
  const RayScene rays(building.rectangles);
  const Eye eye(kCamera);
  const Sight sight = eye.look(looking({0, 0, 0}, 0.0), {&building, &rays});
  EXPECT_EQ(eye.overlap(sight, Sight{}), 0.0);
  EXPECT_EQ(eye.overlap(Sight{}, sight), 0.0);
  EXPECT_EQ(eye.alike(Sight{}, sight, sight.viewpoint), 0.0);
}

// A hall of 12 m x 8 m x 3 m with cupboards standing about.
Building hall(core::Random& random) {
  Building building{.rectangles = test::inside_of({12.0F, 8.0F, 3.0F})};
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector3f low(static_cast<float>(random.uniform(1.0, 10.0)),
                              static_cast<float>(random.uniform(1.0, 6.0)), 0.0F);
    const Eigen::Vector3f size(static_cast<float>(random.uniform(0.2, 1.0)),
                               static_cast<float>(random.uniform(0.2, 1.0)),
                               static_cast<float>(random.uniform(0.5, 2.5)));
    for (Rectangle face : test::inside_of(size)) {
      // its back, from outside
      face.corner_m = face.at({face.size_m.x(), 0.0F}) + low;
      face.right = -face.right;
      building.rectangles.push_back(face);
    }
  }
  return building;
}

// The slow way: a ray from the match to every point.
double overlap_by_rays(const Sight& query, const Sight& match, const RayScene& rays) {
  int num_shared = 0;
  for (const SeenPoint& point : query.points) {
    const Ray ray{match.viewpoint.position_m, point.in_world_m - match.viewpoint.position_m};
    const Eigen::Vector3f in_camera = match.viewpoint.camera_from_world * ray.direction;
    // what lies that far outside would be folded into the picture by the distortion
    if (in_camera.z() < 0.05F || in_camera.head<2>().norm() > in_camera.z()) continue;
    const auto pixel = geometry::project(kTwinCamera, in_camera.cast<double>());
    const bool is_inside =
        pixel && pixel->x() > -0.5 && pixel->y() > -0.5 && pixel->x() < 639.5 && pixel->y() < 479.5;
    const auto hit = rays.first_hit(ray);
    if (!is_inside || !hit || point.normal.dot(ray.direction) >= 0.0F) continue;
    const float error_m = std::abs(hit->reach - 1.0F) * in_camera.z();
    num_shared += error_m <= 0.05F + 0.04F * in_camera.z() ? 1 : 0;
  }
  return static_cast<double>(num_shared) / static_cast<double>(query.points.size());
}

TEST(Overlap, AgreesWithARayToEveryPoint) {
  const Eye eye(kTwinCamera);
  double sum_of_errors = 0.0;
  int num_pairs = 0;
  int num_with_overlap = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    core::Random random(seed);
    const Building building = hall(random);
    const RayScene rays(building.rectangles);
    std::vector<Sight> sights;
    for (int i = 0; i < 16; ++i) {
      const Eigen::Vector3d position_m(random.uniform(0.3, 11.7), random.uniform(0.3, 7.7),
                                       random.uniform(1.2, 2.8));
      sights.push_back(
          eye.look(looking(position_m, random.uniform(-3.0, 3.0)), {&building, &rays}));
    }
    for (const Sight& query : sights) {
      for (const Sight& match : sights) {
        const double expected = overlap_by_rays(query, match, rays);
        const double error = std::abs(eye.overlap(query, match) - expected);
        ASSERT_LE(error, 0.08) << "seed " << seed << ", overlap " << expected;
        sum_of_errors += error;
        ++num_pairs;
        num_with_overlap += expected > 0.05 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(num_with_overlap, num_pairs / 4);
  EXPECT_LT(sum_of_errors / num_pairs, 0.003);
}

TEST(Alike, NeedsTheSamePatternAndLittleOfItsOwn) {
  const auto alike = [](const Material& first, const Material& second) {
    Building a{.rectangles = {wall_at(2.0F)}};
    Building b{.rectangles = {wall_at(2.0F)}};
    a.rectangles[0].material = first;
    b.rectangles[0].material = second;
    const RayScene rays_a(a.rectangles);
    const RayScene rays_b(b.rectangles);
    const Eye eye(kCamera);
    const Sight query = eye.look(looking({0, 0, 0}, 0.0), {&a, &rays_a});
    const Sight match = eye.look(looking({0, 0, 0}, 0.0), {&b, &rays_b});
    return eye.alike(query, match, query.viewpoint);
  };
  const Material wall{.finish = Finish::kWall, .pattern_seed = 3, .own_ratio = 0.5F};
  Material other = wall;
  EXPECT_EQ(alike(wall, other), 1.0);
  other.wear_seed = 9;
  other.own_pattern_seed = 9;
  EXPECT_EQ(alike(wall, other), 1.0) << "stains and what is mixed in do not make another place";
  other.own_ratio = 0.51F;
  EXPECT_EQ(alike(wall, other), 0.0);
  EXPECT_EQ(alike(other, wall), 0.0);
  other = wall;
  other.pattern_seed = 4;
  EXPECT_EQ(alike(wall, other), 0.0);
  other = wall;
  other.finish = Finish::kCork;
  EXPECT_EQ(alike(wall, other), 0.0);
  other = wall;
  other.number = 1;
  EXPECT_EQ(alike(wall, other), 0.0) << "another design, or the number of another room";
}

}  // namespace
}  // namespace samewhere::twin
