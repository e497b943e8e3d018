#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <samewhere/core/random.hpp>
#include <samewhere/optimize/focal_length.hpp>

namespace samewhere::optimize {
namespace {

// Cameras on an arc about points, as a lens of 500 px sees them; the problem assumes `assumed_px`
// and has poses and points that are a little wrong.
BundleProblem arc(double assumed_px, std::uint64_t seed, int num_cameras) {
  core::Random random(seed);
  const core::PinholeRadtan lens{640, 480, 500.0, 500.0, 319.5, 239.5};
  core::PinholeRadtan assumed = lens;
  assumed.fx_px = assumed.fy_px = assumed_px;
  BundleProblem problem;
  for (int i = 0; i < 80; ++i) {
    problem.points_in_world.emplace_back(random.uniform(-1.0, 1.0), random.uniform(-0.8, 0.8),
                                         random.uniform(2.0, 5.0));
  }
  for (int i = 0; i < num_cameras; ++i) {
    const double angle = 0.12 * i;
    const core::Rigid3 world_from_camera{
        core::exp_so3({0.05 * (i % 3), -angle, 0.03 * i}),
        {3.0 * std::sin(angle), 0.1 * (i % 2), 3.0 - 3.0 * std::cos(angle)}};
    const core::Rigid3 camera_from_world = inverse(world_from_camera);
    problem.cameras.push_back({camera_from_world, assumed, 0.0, i < 1});
    for (int j = 0; j < 80; ++j) {
      const Eigen::Vector3d p =
          camera_from_world * problem.points_in_world[static_cast<std::size_t>(j)];
      if (p.z() < 0.5) continue;
      const Eigen::Vector2d pixel = 500.0 * p.hnormalized() + Eigen::Vector2d(319.5, 239.5);
      if (std::abs(pixel.x() - 320) > 320 || std::abs(pixel.y() - 240) > 240) continue;
      const Eigen::Vector2d noise(random.gaussian() * 0.5, random.gaussian() * 0.5);
      problem.observations.push_back({i, j, {pixel + noise, std::nan(""), 1.0}});
    }
  }
  for (auto& point : problem.points_in_world) point.z() *= assumed_px / 500.0;
  return problem;
}

TEST(FocalLength, IsEstimatedFromCamerasAroundAPlace) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    for (const double assumed_px : {420.0, 500.0, 600.0}) {
      SCOPED_TRACE(fmt::format("seed {}, assumed {}", seed, assumed_px));
      const auto fit = fit_focal_length(arc(assumed_px, seed, 8), 0.2);
      ASSERT_TRUE(fit);
      EXPECT_NEAR(fit->ratio * assumed_px, 500.0, 10.0);
      EXPECT_GT(fit->ratio_sigma, 0.0);
      EXPECT_LT(fit->ratio_sigma, 0.02);
    }
  }
}

TEST(FocalLength, IsNotEstimatedFromFewObservations) {
  BundleProblem problem = arc(500.0, 1, 8);
  problem.observations.resize(100);
  EXPECT_FALSE(fit_focal_length(problem, 0.2));
  EXPECT_FALSE(fit_focal_length({}, 0.2));
}

}  // namespace
}  // namespace samewhere::optimize
