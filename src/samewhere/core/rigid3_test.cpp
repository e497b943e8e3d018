#include <numbers>

#include <gtest/gtest.h>

#include <samewhere/core/random.hpp>
#include <samewhere/core/rigid3.hpp>

namespace samewhere::core {
namespace {

constexpr int kNumSeeds = 100;

Eigen::Vector3d random_vector(Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

// Uniform axis, angle up to just below pi, where the logarithm is unique.
Eigen::Vector3d random_rotation_rad(Random& random) {
  const Eigen::Vector3d axis(random.gaussian(), random.gaussian(), random.gaussian());
  return random.uniform(0.0, std::numbers::pi - 1e-3) * axis.normalized();
}

Rigid3 random_rigid(Random& random) {
  return {exp_so3(random_rotation_rad(random)), random_vector(random, 10.0)};
}

Sim3 random_sim(Random& random) {
  const Rigid3 rigid = random_rigid(random);
  return {random.uniform(0.1, 10.0), rigid.rotation, rigid.translation};
}

double distance(const Rigid3& a, const Rigid3& b) { return (a.matrix() - b.matrix()).norm(); }

TEST(Rigid3, TheInverseUndoes) {
  for (int seed = 0; seed < kNumSeeds; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Rigid3 a_from_b = random_rigid(random);
    const Eigen::Vector3d x_in_b = random_vector(random, 10.0);
    EXPECT_LT((inverse(a_from_b) * (a_from_b * x_in_b) - x_in_b).norm(), 1e-12);
    EXPECT_LT(distance(inverse(a_from_b) * a_from_b, Rigid3{}), 1e-12);
  }
}

TEST(Rigid3, NeighboursCancelAsTheMatricesDo) {
  for (int seed = 0; seed < kNumSeeds; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Rigid3 a_from_b = random_rigid(random);
    const Rigid3 b_from_c = random_rigid(random);
    const Eigen::Vector3d x_in_c = random_vector(random, 10.0);
    const Rigid3 a_from_c = a_from_b * b_from_c;
    EXPECT_LT((a_from_c * x_in_c - a_from_b * (b_from_c * x_in_c)).norm(), 1e-12);
    EXPECT_LT((a_from_c.matrix() - a_from_b.matrix() * b_from_c.matrix()).norm(), 1e-12);
    EXPECT_LT(distance(Rigid3::from_matrix(a_from_c.matrix()), a_from_c), 1e-12);
  }
}

TEST(Rigid3, ARotationStaysARotationOverAMillionProducts) {
  Random random(1);
  const Rigid3 step = random_rigid(random);
  Rigid3 product;
  for (int i = 0; i < 1'000'000; ++i) product = product * step;
  const Eigen::Matrix3d rotation = product.rotation.toRotationMatrix();
  EXPECT_LT((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_NEAR(rotation.determinant(), 1.0, 1e-12);
}

TEST(Rigid3, ExpAndLogUndoEachOther) {
  for (int seed = 0; seed < kNumSeeds; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Vector6d tangent;
    tangent << random_vector(random, 10.0), random_rotation_rad(random);
    EXPECT_LT((log_r3so3(exp_r3so3(tangent)) - tangent).norm(), 1e-12);
  }
}

TEST(Rigid3, ExpIsTheRotationOfAxisAndAngle) {
  for (int seed = 0; seed < kNumSeeds; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Eigen::Vector3d rotation_rad = random_rotation_rad(random);
    const Eigen::Matrix3d expected =
        Eigen::AngleAxisd(rotation_rad.norm(), rotation_rad.normalized()).toRotationMatrix();
    EXPECT_LT((exp_so3(rotation_rad).toRotationMatrix() - expected).norm(), 1e-12);
  }
}

class AngleTest : public testing::TestWithParam<double> {};

// Where the closed forms divide zero by zero, and where the axis is about to flip.
TEST_P(AngleTest, ExpAndLogUndoEachOtherAtTheEdges) {
  const double angle = GetParam();
  for (int seed = 0; seed < kNumSeeds; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Eigen::Vector3d axis(random.gaussian(), random.gaussian(), random.gaussian());
    const Eigen::Vector3d rotation_rad = angle * axis.normalized();
    const Eigen::Vector3d back_rad = log_so3(exp_so3(rotation_rad));
    EXPECT_LT((back_rad - rotation_rad).norm(), 1e-14 + 1e-13 * angle);
    EXPECT_NEAR(angle_rad(exp_so3(rotation_rad)), angle, 1e-13);
  }
}

INSTANTIATE_TEST_SUITE_P(Rigid3, AngleTest,
                         testing::Values(0.0, 1e-300, 1e-12, 0.99e-9, 1.01e-9, 0.99e-6, 1.01e-6,
                                         1e-3, 3.14, std::numbers::pi - 1e-9,
                                         std::numbers::pi - 1e-12));

TEST(Rigid3, LogTakesTheShortWayWhateverTheSignOfTheQuaternion) {
  for (int seed = 0; seed < kNumSeeds; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Eigen::Quaterniond q = exp_so3(random_rotation_rad(random));
    const Eigen::Quaterniond minus_q(-q.w(), -q.x(), -q.y(), -q.z());
    EXPECT_LT((log_so3(q) - log_so3(minus_q)).norm(), 1e-12);
    EXPECT_DOUBLE_EQ(angle_rad(q), angle_rad(minus_q));
  }
}

TEST(Rigid3, InterpolationMeetsItsEndsAndKeepsItsSpeed) {
  for (int seed = 0; seed < kNumSeeds; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Rigid3 first = random_rigid(random);
    const Rigid3 second = random_rigid(random);
    const double ratio = random.uniform();
    EXPECT_LT(distance(interpolate(first, second, 0.0), first), 1e-12);
    EXPECT_LT(distance(interpolate(first, second, 1.0), second), 1e-12);
    const Rigid3 between = interpolate(first, second, ratio);
    const double whole_rad = angle_rad(first.rotation.conjugate() * second.rotation);
    const double part_rad = angle_rad(first.rotation.conjugate() * between.rotation);
    EXPECT_NEAR(part_rad, ratio * whole_rad, 1e-9);
    EXPECT_NEAR((between.translation - first.translation).norm(),
                ratio * (second.translation - first.translation).norm(), 1e-9);
  }
}

TEST(Rigid3, SkewIsTheCrossProduct) {
  Random random(7);
  const Eigen::Vector3d a = random_vector(random, 1.0);
  const Eigen::Vector3d b = random_vector(random, 1.0);
  EXPECT_LT((skew(a) * b - a.cross(b)).norm(), 1e-15);
}

TEST(Rigid3, NanAndInfinityAreNotFinite) {
  EXPECT_TRUE(is_finite(Rigid3{}));
  Rigid3 bad_translation;
  bad_translation.translation.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(is_finite(bad_translation));
  Rigid3 bad_rotation;
  bad_rotation.rotation.w() = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(is_finite(bad_rotation));
}

TEST(Sim3, TheInverseUndoesAndNeighboursCancel) {
  for (int seed = 0; seed < kNumSeeds; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Sim3 a_from_b = random_sim(random);
    const Sim3 b_from_c = random_sim(random);
    const Eigen::Vector3d x_in_c = random_vector(random, 10.0);
    EXPECT_LT((inverse(b_from_c) * (b_from_c * x_in_c) - x_in_c).norm(), 1e-11);
    EXPECT_LT((a_from_b * b_from_c * x_in_c - a_from_b * (b_from_c * x_in_c)).norm(), 1e-10);
    EXPECT_NEAR((inverse(a_from_b) * a_from_b).scale, 1.0, 1e-12);
  }
}

TEST(Sim3, WithScaleOneItIsTheRigidTransform) {
  Random random(3);
  const Rigid3 a_from_b = random_rigid(random);
  const Eigen::Vector3d x_in_b = random_vector(random, 10.0);
  EXPECT_LT((Sim3::from_rigid(a_from_b) * x_in_b - a_from_b * x_in_b).norm(), 1e-14);
  EXPECT_LT(distance(rigid_part(Sim3::from_rigid(a_from_b)), a_from_b), 1e-15);
}

}  // namespace
}  // namespace samewhere::core
