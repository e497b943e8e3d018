#include <numbers>

#include <gtest/gtest.h>

#include <samewhere/evaluate/depth_places.hpp>

namespace samewhere::evaluate {
namespace {

constexpr double kWallDistance_m = 2.0;

// 90 degrees wide: 2 m before a wall it sees 4 m of it.
core::Camera wide_camera() {
  return core::PinholeRadtan{.width_px = 160,
                             .height_px = 120,
                             .fx_px = 80.0,
                             .fy_px = 80.0,
                             .cx_px = 79.5,
                             .cy_px = 59.5};
}

// Perpendicular to a wall, so far aside.
DepthView before_wall(double aside_m) {
  DepthView view{cv::Mat(120, 160, CV_32F, cv::Scalar(kWallDistance_m)), {}};
  view.world_from_camera.translation.x() = aside_m;
  return view;
}

core::PlaceTruth place_at(double aside_m) {
  return places_from_depth({before_wall(0.0), before_wall(aside_m)}, wide_camera()).at(1, 0);
}

TEST(PlacesFromDepth, TheSharedPartOfAWallDecides) {
  EXPECT_EQ(place_at(0.0), core::PlaceTruth::kSame);
  EXPECT_EQ(place_at(2.7), core::PlaceTruth::kSame) << "32 % are shared";
  EXPECT_EQ(place_at(3.0), core::PlaceTruth::kNear) << "25 %";
  EXPECT_EQ(place_at(3.9), core::PlaceTruth::kDifferent) << "2 %";
  EXPECT_EQ(place_at(5.0), core::PlaceTruth::kDifferent);
}

TEST(PlacesFromDepth, AnotherWallBehindIsAnotherPlace) {
  DepthView farther = before_wall(0.0);
  farther.depth_m = cv::Mat(120, 160, CV_32F, cv::Scalar(1.2 * kWallDistance_m));
  EXPECT_EQ(places_from_depth({before_wall(0.0), farther}, wide_camera()).at(1, 0),
            core::PlaceTruth::kDifferent);
}

TEST(PlacesFromDepth, ViewsThatShareASurfaceFromOtherSidesAreNear) {
  // the middle of a sphere, turned: depth is the range times the cosine
  const auto in_sphere = [](double turned_rad) {
    DepthView view{cv::Mat(120, 160, CV_32F), {}};
    for (int y = 0; y < 120; ++y) {
      for (int x = 0; x < 160; ++x) {
        const Eigen::Vector3d ray((x - 79.5) / 80.0, (y - 59.5) / 80.0, 1.0);
        view.depth_m.at<float>(y, x) = static_cast<float>(kWallDistance_m / ray.norm());
      }
    }
    view.world_from_camera.rotation = core::exp_so3(turned_rad * Eigen::Vector3d::UnitY());
    return view;
  };
  const auto turned_by = [&](double degrees) {
    const double turned_rad = degrees * std::numbers::pi / 180.0;
    return places_from_depth({in_sphere(0.0), in_sphere(turned_rad)}, wide_camera()).at(0, 1);
  };
  EXPECT_EQ(turned_by(40.0), core::PlaceTruth::kSame);
  EXPECT_EQ(turned_by(50.0), core::PlaceTruth::kNear);
}

TEST(PlacesFromDepth, WithoutAPoseAFrameIsNearToAllOthers) {
  const auto places =
      places_from_depth({before_wall(0.0), std::nullopt, before_wall(0.1)}, wide_camera());
  EXPECT_EQ(places.num_frames, 3);
  EXPECT_EQ(places.at(1, 0), core::PlaceTruth::kNear);
  EXPECT_EQ(places.at(2, 1), core::PlaceTruth::kNear);
  EXPECT_EQ(places.at(2, 0), core::PlaceTruth::kSame);
  EXPECT_EQ(places.at(1, 1), core::PlaceTruth::kSame);
}

}  // namespace
}  // namespace samewhere::evaluate
