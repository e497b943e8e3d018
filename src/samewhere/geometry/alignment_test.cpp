#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/geometry/alignment.hpp>

namespace samewhere::geometry {
namespace {

using Points = std::vector<Eigen::Vector3d>;

Eigen::Vector3d random_vector(core::Random& random) {
  return {random.gaussian(), random.gaussian(), random.gaussian()};
}

core::Sim3 random_transform(core::Random& random, bool with_scale) {
  const double scale = with_scale ? random.uniform(0.1, 5.0) : 1.0;
  return {scale, core::exp_so3(2.0 * random_vector(random)), 10.0 * random_vector(random)};
}

Points random_points(core::Random& random, int count) {
  Points points;
  for (int i = 0; i < count; ++i) points.push_back(random_vector(random));
  return points;
}

Points moved(const core::Sim3& to_from_from, const Points& points) {
  Points result;
  for (const Eigen::Vector3d& point : points) result.push_back(to_from_from * point);
  return result;
}

double sum_of_squares(const core::Sim3& to_from_from, const Points& from, const Points& to) {
  double sum = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i)
    sum += (to[i] - to_from_from * from[i]).squaredNorm();
  return sum;
}

double turn_between(const core::Sim3& a, const core::Sim3& b) {
  return core::angle_rad(a.rotation.conjugate() * b.rotation);
}

TEST(Alignment, UndoesARandomTransform) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    core::Random random(seed);
    const bool with_scale = seed % 2 == 0;
    const core::Sim3 truth = random_transform(random, with_scale);
    const Points from = random_points(random, 3 + static_cast<int>(random.index(20)));
    const core::Sim3 found = align_points(from, moved(truth, from), with_scale);
    EXPECT_NEAR(found.scale, truth.scale, 1e-9);
    EXPECT_LT(turn_between(found, truth), 1e-7);
    EXPECT_LT((found.translation - truth.translation).norm(), 1e-8);
  }
}

TEST(Alignment, NoNearbyTransformFitsNoisyPointsBetter) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    core::Random random(seed);
    const Points from = random_points(random, 12);
    Points to = moved(random_transform(random, true), from);
    for (Eigen::Vector3d& point : to) point += 0.3 * random_vector(random);
    const bool with_scale = seed % 2 == 0;
    const core::Sim3 best = align_points(from, to, with_scale);
    for (int trial = 0; trial < 20; ++trial) {
      core::Sim3 other = best;
      if (with_scale) other.scale *= 1.0 + 1e-3 * random.gaussian();
      other.rotation = core::exp_so3(1e-3 * random_vector(random)) * other.rotation;
      other.translation += 1e-3 * random_vector(random);
      EXPECT_LE(sum_of_squares(best, from, to), sum_of_squares(other, from, to));
    }
  }
}

TEST(Alignment, AMirrorImageIsNotUndoneByAMirror) {
  core::Random random(5);
  const Points from = random_points(random, 10);
  Points to = from;
  for (Eigen::Vector3d& point : to) point.x() = -point.x();
  const core::Sim3 found = align_points(from, to, false);
  EXPECT_NEAR(found.rotation.toRotationMatrix().determinant(), 1.0, 1e-12);
  EXPECT_GT(sum_of_squares(found, from, to), 0.1);
}

TEST(Alignment, WithoutScaleTheScaleIsExactlyOne) {
  core::Random random(6);
  const Points from = random_points(random, 10);
  Points to = from;
  for (Eigen::Vector3d& point : to) point *= 3.0;
  EXPECT_EQ(align_points(from, to, false).scale, 1.0);
  EXPECT_NEAR(align_points(from, to, true).scale, 3.0, 1e-12);
}

TEST(Alignment, PointsOnALineTurnNoMoreThanTheLineDoes) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    core::Random random(seed);
    const Eigen::Vector3d start = 5.0 * random_vector(random);
    const Eigen::Vector3d direction = random_vector(random).normalized();
    Points from;
    for (int i = 0; i < 6; ++i) from.emplace_back(start + random.gaussian() * direction);
    const core::Sim3 truth = random_transform(random, true);
    const Points to = moved(truth, from);
    const core::Sim3 found = align_points(from, to, true);
    EXPECT_LT(sum_of_squares(found, from, to), 1e-18);
    const double turn_of_line_rad =
        std::acos(std::clamp(direction.dot(truth.rotation * direction), -1.0, 1.0));
    EXPECT_NEAR(core::angle_rad(found.rotation), turn_of_line_rad, 1e-6);
  }
}

TEST(Alignment, AStandingCameraIsShiftedAndNothingElse) {
  const Points standing(5, {0.1, 0.7, -1.3});
  core::Random random(7);
  const Points walking = random_points(random, 5);
  for (const auto& [from, to] : {std::pair{standing, walking}, std::pair{walking, standing}}) {
    const core::Sim3 found = align_points(from, to, true);
    EXPECT_EQ(found.scale, 1.0);
    EXPECT_EQ(core::angle_rad(found.rotation), 0.0);
    EXPECT_TRUE(found.translation.allFinite());
  }
}

TEST(Alignment, RefusesWhatNoCallerMayAsk) {
  const Points two(2, Eigen::Vector3d::Zero());
  Points with_nan(3, Eigen::Vector3d::Zero());
  with_nan[1].y() = std::nan("");
  const Points three(3, Eigen::Vector3d::Zero());
  EXPECT_THROW(align_points(two, two, false), core::ContractError);
  EXPECT_THROW(align_points(two, three, false), core::ContractError);
  EXPECT_THROW(align_points(with_nan, three, false), core::ContractError);
}

}  // namespace
}  // namespace samewhere::geometry
