#include "carried_pixels.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include <samewhere/geometry/camera.hpp>
#include <samewhere/twin/front/camera.hpp>

namespace samewhere::bench {
namespace {

const core::Camera kPixelCamera = twin::kTwinCamera;
const Eigen::Vector3d kLow_m(-1.5, -1.2, -2.0);
const Eigen::Vector3d kHigh_m(1.5, 1.2, 9.0);

// From the eye within a box to its wall, along the optical axis.
double depth_m_of(const core::Rigid3& world_from_camera, const Eigen::Vector3d& bearing) {
  const Eigen::Vector3d in_world = world_from_camera.rotation * (bearing / bearing.z());
  double depth_m = 1e9;
  for (int axis = 0; axis < 3; ++axis) {
    const double wall_m = in_world[axis] > 0.0 ? kHigh_m[axis] : kLow_m[axis];
    const double way_m = (wall_m - world_from_camera.translation[axis]) / in_world[axis];
    if (way_m > 0.0) depth_m = std::min(depth_m, way_m);
  }
  return depth_m;
}

DepthView seen_from(const core::Rigid3& world_from_camera) {
  const core::PinholeRadtan& camera = geometry::pinhole(kPixelCamera);
  DepthView view{cv::Mat(camera.height_px, camera.width_px, CV_32F), world_from_camera};
  for (int y = 0; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x) {
      view.depth_m.at<float>(y, x) = static_cast<float>(
          depth_m_of(world_from_camera, geometry::bearing(kPixelCamera, Eigen::Vector2d(x, y))));
    }
  }
  return view;
}

core::Rigid3 pose(const Eigen::Vector3d& at_m, double turned_rad) {
  return {core::exp_so3(Eigen::Vector3d(0.0, turned_rad, 0.0)), at_m};
}

struct Told {
  double share_small = 0.0;  // residuals below 1 %
  double median = 0.0;
};

Told told(const DepthView& from, const DepthView& to) {
  std::vector<double> residuals;
  for (const auto& pixel : carried_pixels(kPixelCamera, from, to, 12)) {
    residuals.push_back(pixel.depth_residual());
  }
  EXPECT_GT(residuals.size(), 500U);
  std::sort(residuals.begin(), residuals.end());
  const auto num_small = std::lower_bound(residuals.begin(), residuals.end(), 0.01);
  return {
      static_cast<double>(num_small - residuals.begin()) / static_cast<double>(residuals.size()),
      residuals[residuals.size() / 2]};
}

TEST(CarriedPixels, AreAsDeepAsForetoldAndTellMistakesSmallAndLarge) {
  const core::Rigid3 first = pose({0.1, 0.0, 0.0}, 0.05);
  const core::Rigid3 second = pose({-0.1, 0.05, 0.9}, -0.1);
  const DepthView from = seen_from(first);
  const DepthView to = seen_from(second);
  const Told right = told(from, to);
  EXPECT_GT(right.share_small, 0.99);
  EXPECT_LT(right.median, 2e-5);

  DepthView shifted = to;  // by 3 mm
  shifted.world_from_camera.translation += Eigen::Vector3d(0.001, 0.001, 0.003);
  EXPECT_GT(told(from, shifted).median, 2e-4);
  DepthView turned = to;  // by 0.1 degrees
  turned.world_from_camera = to.world_from_camera * pose(Eigen::Vector3d::Zero(), 0.00175);
  EXPECT_GT(told(from, turned).median, 2e-4);
  DepthView stretched_from = from;  // both by 0.3 %
  DepthView stretched_to = to;
  stretched_from.depth_m = 1.003 * from.depth_m;
  stretched_to.depth_m = 1.003 * to.depth_m;
  EXPECT_GT(told(stretched_from, stretched_to).median, 2e-4);

  DepthView swapped = from;
  swapped.world_from_camera = second;
  EXPECT_LT(told(swapped, {to.depth_m, first}).share_small, 0.5);
}

}  // namespace
}  // namespace samewhere::bench
