// Depth from the two cameras of a twin building, whose true depth is known.

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/median.hpp>
#include <samewhere/features/orb.hpp>
#include <samewhere/features/stereo.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/twin/front/twin.hpp>

namespace samewhere {
namespace {

constexpr int kNumFrames = 31;
constexpr int kStep_frames = 10;

core::PinholeRadtan without_distortion(core::PinholeRadtan camera) {
  camera.k1 = camera.k2 = camera.p1 = camera.p2 = camera.k3 = 0.0;
  return camera;
}

// What an ideal pinhole of the same intrinsics sees.
cv::Mat undistorted(const cv::Mat& image, const core::Camera& camera, int interpolation) {
  cv::Mat from(image.size(), CV_32FC2);
  for (int y = 0; y < from.rows; ++y) {
    for (int x = 0; x < from.cols; ++x) {
      const auto pixel =
          *geometry::project(camera, geometry::bearing_of_undistorted(camera, {x, y}));
      from.at<cv::Vec2f>(y, x) =
          cv::Vec2f(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
    }
  }
  cv::Mat result;
  cv::remap(image, result, from, cv::noArray(), interpolation, cv::BORDER_REPLICATE);
  return result;
}

core::Frame rectified(const core::Frame& frame) {
  auto rig = std::make_shared<core::Rig>(*frame.rig);
  core::Frame result = frame;
  for (std::size_t i = 0; i < rig->cameras.size(); ++i) {
    result.images[i] = undistorted(frame.images[i], rig->cameras[i], cv::INTER_LINEAR);
    rig->cameras[i] = without_distortion(geometry::pinhole(frame.rig->cameras[i]));
  }
  result.rig = rig;
  return result;
}

// Features by distance.
struct Class {
  double max_depth_m = 0.0;
  int num_features = 0;
  std::vector<double> relative_errors = {};
};

void count(const features::Features& found, const cv::Mat& true_depth_m,
           std::array<Class, 3>& classes) {
  for (std::size_t i = 0; i < found.raw_px.size(); ++i) {
    const double depth_m =
        true_depth_m.at<float>(static_cast<int>(std::lround(found.raw_px[i].y())),
                               static_cast<int>(std::lround(found.raw_px[i].x())));
    if (depth_m <= 0.0) continue;
    const auto of = std::find_if(classes.begin(), classes.end(),
                                 [&](const Class& one) { return depth_m < one.max_depth_m; });
    if (of == classes.end()) continue;
    ++of->num_features;
    if (found.depth_m[i] > 0.0F) {
      of->relative_errors.push_back(std::abs(found.depth_m[i] - depth_m) / depth_m);
    }
  }
}

TEST(Stereo, MostFeaturesOfARenderedPairHaveTheirTrueDepth) {
  cv::setNumThreads(1);
  const auto pairs = twin::open_twin("twin:office-loop?camera=stereo&seed=7",
                                     {.num_frames = kNumFrames, .num_workers = 2});
  const auto truth =
      twin::open_twin("twin:office-loop?camera=rgbd&seed=7",
                      {.ideal_depth = true, .num_frames = kNumFrames, .num_workers = 2});
  std::array<Class, 3> classes = {Class{2.0}, Class{4.0}, Class{8.0}};
  for (int i = 0; i < kNumFrames; ++i) {
    const auto pair = pairs->next();
    const auto exact = truth->next();
    ASSERT_TRUE(pair && exact);
    if (i % kStep_frames != 0) continue;
    const features::View view = features::extract(rectified(*pair), {});
    count(*view.features, undistorted(*exact->depth_m, exact->rig->cameras[0], cv::INTER_NEAREST),
          classes);
  }
  const std::array<double, 3> max_errors = {0.01, 0.02, 0.05};
  for (std::size_t i = 0; i < classes.size(); ++i) {
    const Class& of = classes[i];
    const double share =
        static_cast<double>(of.relative_errors.size()) / std::max(1, of.num_features);
    SCOPED_TRACE(testing::Message() << "up to " << of.max_depth_m << " m: " << of.num_features
                                    << " features, share with depth " << share);
    const auto median = core::median(of.relative_errors);
    ASSERT_TRUE(median);
    EXPECT_GT(share, 0.45);
    EXPECT_LT(*median, max_errors[i]);
  }
}

}  // namespace
}  // namespace samewhere
