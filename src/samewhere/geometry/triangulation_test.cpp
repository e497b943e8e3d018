#include <gtest/gtest.h>

#include <samewhere/geometry/test_pairs.hpp>
#include <samewhere/geometry/triangulation.hpp>

namespace samewhere::geometry {
namespace {

TEST(Triangulation, ExactRaysMeetInTheirPoint) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    core::Random random(seed);
    const core::Rigid3 second_from_first = random_motion(random);
    const Eigen::Vector3d point(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(2, 8));
    const auto found = triangulate(second_from_first, point.normalized(),
                                   (second_from_first * point).normalized());
    ASSERT_TRUE(found) << "seed " << seed;
    EXPECT_LT((*found - point).norm(), 1e-6) << "seed " << seed;
  }
}

TEST(Triangulation, NoiseMovesThePointHardlyBesideTheRays) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    core::Random random(seed);
    const core::Rigid3 second_from_first{core::exp_so3({0.0, -0.1, 0.0}), {-0.6, 0.1, 0.0}};
    const Eigen::Vector3d point(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(2, 4));
    const auto found = triangulate(second_from_first, with_noise(point, 0.5, random),
                                   with_noise(second_from_first * point, 0.5, random));
    ASSERT_TRUE(found) << "seed " << seed;
    EXPECT_LT((found->hnormalized() - point.hnormalized()).norm() * kTestFocal_px, 3.0)
        << "seed " << seed;
    EXPECT_NEAR(found->z() / point.z(), 1.0, 0.1) << "seed " << seed;
  }
}

TEST(Triangulation, RaysThatPointApartOrNowhereHaveNoPoint) {
  const core::Rigid3 sideways{Eigen::Quaterniond::Identity(), {-1.0, 0.0, 0.0}};
  const Eigen::Vector3d ahead = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d left = Eigen::Vector3d(-0.2, 0.0, 1.0).normalized();
  EXPECT_TRUE(triangulate(sideways, ahead, left));
  EXPECT_FALSE(triangulate(sideways, left, ahead)) << "they would meet behind both cameras";
  EXPECT_FALSE(triangulate(sideways, ahead, ahead)) << "parallel";
  EXPECT_FALSE(triangulate({}, ahead, left)) << "one and the same place";
}

TEST(Triangulation, ParallaxIsWhatTheRotationLeaves) {
  const Eigen::Quaterniond turn = core::exp_so3({0.1, -0.2, 0.05});
  const Eigen::Vector3d ray = Eigen::Vector3d(0.1, 0.2, 1.0).normalized();
  EXPECT_NEAR(parallax_rad(turn, ray, turn * ray), 0.0, 1e-9);
  EXPECT_NEAR(parallax_rad(Eigen::Quaterniond::Identity(), Eigen::Vector3d::UnitZ(),
                           core::exp_so3({0.3, 0.0, 0.0}) * Eigen::Vector3d::UnitZ()),
              0.3, 1e-12);
}

}  // namespace
}  // namespace samewhere::geometry
