#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include <samewhere/core/random.hpp>
#include <samewhere/report/las.hpp>

namespace samewhere::report {
namespace {

// Read back by the offsets of the specification.
template <class T>
T las_value(const std::string& bytes, std::size_t at) {
  T value{};
  std::memcpy(&value, bytes.substr(at).data(), sizeof value);
  return value;
}

Eigen::Vector3d las_point(const std::string& bytes, std::size_t i) {
  Eigen::Vector3d point;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    point(static_cast<Eigen::Index>(axis)) =
        las_value<std::int32_t>(bytes, 227 + 26 * i + 4 * axis) *
            las_value<double>(bytes, 131 + 8 * axis) +
        las_value<double>(bytes, 155 + 8 * axis);
  }
  return point;
}

TEST(Las, PointsAreReadBackToATenthOfAMillimetre) {
  core::Random random(1);
  std::vector<ColouredPoint> points;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d in_world(random.uniform(-90.0, 80.0), random.uniform(-2.0, 1.0),
                                   random.uniform(-5.0, 70.0));
    points.push_back({in_world.cast<float>(), {0, 255, static_cast<std::uint8_t>(i)}});
  }
  const std::string bytes = las_bytes(points);
  ASSERT_EQ(bytes.size(), 227U + 100U * 26U);
  EXPECT_EQ(bytes.substr(0, 4), "LASF");
  EXPECT_EQ(las_value<std::uint16_t>(bytes, 94), 227);
  EXPECT_EQ(las_value<std::uint32_t>(bytes, 96), 227U);
  EXPECT_EQ(las_value<std::uint8_t>(bytes, 104), 2);
  EXPECT_EQ(las_value<std::uint16_t>(bytes, 105), 26);
  EXPECT_EQ(las_value<std::uint32_t>(bytes, 107), 100U);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_LT((las_point(bytes, i) - points[i].in_world.cast<double>()).norm(), 1e-4) << i;
    EXPECT_EQ(las_value<std::uint16_t>(bytes, 227 + 26 * i + 22), 65535);
    EXPECT_EQ(las_value<std::uint16_t>(bytes, 227 + 26 * i + 24), 257 * i);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto x = static_cast<double>(points[i].in_world(static_cast<Eigen::Index>(axis)));
      EXPECT_LE(x, las_value<double>(bytes, 179 + 16 * axis));
      EXPECT_GE(x, las_value<double>(bytes, 187 + 16 * axis));
    }
  }
}

TEST(Las, FarPointsFitIntoAWiderStep) {
  const std::string bytes = las_bytes(
      {{{-1e7F, 0.0F, 0.0F}, {}}, {{1e7F, 5.0F, 0.0F}, {}}, {{std::nanf(""), 0.0F, 0.0F}, {}}});
  ASSERT_EQ(las_value<std::uint32_t>(bytes, 107), 2U) << "what is not finite is left out";
  EXPECT_NEAR(las_point(bytes, 0).x(), -1e7, 0.01);
  EXPECT_NEAR(las_point(bytes, 1).x(), 1e7, 0.01);
  EXPECT_NEAR(las_point(bytes, 1).y(), 5.0, 0.01);
}

TEST(Las, NoPointIsAFileToo) { EXPECT_EQ(las_bytes({}).size(), 227U); }

}  // namespace
}  // namespace samewhere::report
