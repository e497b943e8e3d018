#include <limits>

#include <gtest/gtest.h>

#include <samewhere/dense/test_room.hpp>
#include <samewhere/dense/view.hpp>

namespace samewhere::dense {
namespace {

View wall(float depth_m) {
  return {TestRoom::camera(),
          {Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX())), {1.0, 2.0, 3.0}},
          cv::Mat(TestRoom::kHeight_px, TestRoom::kWidth_px, CV_8UC3, cv::Scalar(1, 2, 3)),
          cv::Mat(TestRoom::kHeight_px, TestRoom::kWidth_px, CV_32F, cv::Scalar(depth_m))};
}

TEST(PointReader, PointsLieOnTheSurfaces) {
  PointReader reader({.step_px = 3, .max_depth_m = 10.0});
  const core::Rigid3 room_from_world = inverse(TestRoom::world_from_room());
  const auto points = reader.points(TestRoom::view({0.8, 0.7, 1.2}, 0.5));
  ASSERT_GT(points.size(), 1000U);
  for (const auto& point : points) {
    EXPECT_LT(
        TestRoom::distance_m(room_from_world * Eigen::Vector3d(point.in_world.cast<double>())),
        1e-5);
  }
}

TEST(PointReader, TheColourIsRedGreenBlue) {
  PointReader reader({});
  const auto points = reader.points(wall(1.0F));
  ASSERT_FALSE(points.empty());
  EXPECT_EQ(points.front().rgb, (std::array<std::uint8_t, 3>{3, 2, 1}));
}

TEST(PointReader, UnknownDepthGivesNoPoint) {
  PointReader reader({.max_depth_m = 4.0});
  EXPECT_FALSE(reader.points(wall(2.0F)).empty());
  for (const float depth_m : {0.0F, -1.0F, 0.1F, 4.1F, std::numeric_limits<float>::quiet_NaN(),
                              std::numeric_limits<float>::infinity()}) {
    EXPECT_TRUE(reader.points(wall(depth_m)).empty()) << depth_m;
  }
}

TEST(PointReader, PixelsOnAnEdgeAreNotUsed) {
  constexpr int kEdge_px = 80;
  View step = wall(1.0F);
  step.depth_m.colRange(kEdge_px, step.depth_m.cols).setTo(2.0);
  PointReader reader({.step_px = 1});
  EXPECT_EQ(reader.points(step).size(),
            static_cast<std::size_t>((TestRoom::kWidth_px - 2) * TestRoom::kHeight_px));
}

TEST(PointReader, AnotherCameraHasOtherRays) {
  PointReader reader({});
  View view = wall(1.0F);
  const auto narrow = reader.points(view);
  core::PinholeRadtan wide = TestRoom::camera();
  wide.fx_px /= 2.0;
  view.camera = wide;
  EXPECT_NEAR(reader.points(view).front().in_camera.x(), 2.0 * narrow.front().in_camera.x(), 1e-5);
}

}  // namespace
}  // namespace samewhere::dense
