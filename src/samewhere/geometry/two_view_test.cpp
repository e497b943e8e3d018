#include <gtest/gtest.h>

#include <samewhere/core/rigid3.hpp>
#include <samewhere/geometry/two_view.hpp>

namespace samewhere::geometry {
namespace {

// Two views of a random scene by a 500 px camera, the second moved sideways and turned a little.
PixelPairs two_views(core::Random& random, int count, double noise_px, double outlier_ratio) {
  const core::Rigid3 second_from_first{core::exp_so3({0.02, -0.1, 0.03}), {0.5, 0.1, -0.2}};
  const auto pixel = [&](const Eigen::Vector3d& p) {
    return Eigen::Vector2d(500.0 * p.x() / p.z() + 320.0 + noise_px * random.gaussian(),
                           500.0 * p.y() / p.z() + 240.0 + noise_px * random.gaussian());
  };
  PixelPairs pairs;
  for (int i = 0; i < count; ++i) {
    const double depth_m = random.uniform(2.0, 8.0);
    const Eigen::Vector3d in_first(random.uniform(-0.5, 0.5) * depth_m,
                                   random.uniform(-0.4, 0.4) * depth_m, depth_m);
    pairs.first_px.push_back(pixel(in_first));
    pairs.second_px.push_back(random.uniform() < outlier_ratio
                                  ? Eigen::Vector2d(random.uniform(0, 640), random.uniform(0, 480))
                                  : pixel(second_from_first * in_first));
  }
  return pairs;
}

double worst_error(const Eigen::Matrix3d& fundamental, const PixelPairs& pairs) {
  double worst = 0.0;
  for (std::size_t i = 0; i < pairs.first_px.size(); ++i) {
    worst = std::max(worst, sampson_squared(fundamental, pairs.first_px[i], pairs.second_px[i]));
  }
  return std::sqrt(worst);
}

TEST(Fundamental, SevenExactPairsGiveAMatrixThatFitsAllOthers) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    core::Random random(seed);
    const PixelPairs all = two_views(random, 50, 0.0, 0.0);
    const PixelPairs seven{{all.first_px.begin(), all.first_px.begin() + 7},
                           {all.second_px.begin(), all.second_px.begin() + 7}};
    double best = 1e9;
    for (const auto& fundamental : solve_fundamental_7(seven))
      best = std::min(best, worst_error(fundamental, all));
    EXPECT_LT(best, 1e-3) << "seed " << seed;
  }
}

TEST(Fundamental, EightPairsOrMoreGiveRankTwo) {
  core::Random random(4);
  const auto fundamental = solve_fundamental_8(two_views(random, 60, 0.3, 0.0));
  ASSERT_TRUE(fundamental);
  EXPECT_LT(std::abs(fundamental->normalized().determinant()), 1e-12);
  EXPECT_FALSE(solve_fundamental_8(two_views(random, 7, 0.0, 0.0)));
}

TEST(Fundamental, IsFoundAmongHalfOutliers) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    core::Random random(seed);
    const PixelPairs pairs = two_views(random, 200, 0.5, 0.5);
    const auto result = estimate_fundamental(
        pairs, {.max_error_px = 2.0, .max_iterations = 2000, .min_inliers = 20}, random);
    ASSERT_TRUE(result) << "seed " << seed;
    EXPECT_GT(result->inliers.size(), 85U) << "seed " << seed;
    EXPECT_LT(result->inliers.size(), 135U) << "seed " << seed;
  }
}

TEST(Fundamental, TooFewPairsHaveNone) {
  core::Random random(1);
  EXPECT_FALSE(estimate_fundamental(two_views(random, 6, 0.0, 0.0), {}, random));
  EXPECT_FALSE(estimate_fundamental({}, {}, random));
}

}  // namespace
}  // namespace samewhere::geometry
