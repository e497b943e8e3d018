#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/geometry/camera_check.hpp>
#include <samewhere/input/camera_file.hpp>
#include <samewhere/input/rectify.hpp>
#include <samewhere/input/straighten.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using core::PinholeRadtan;

const PinholeRadtan& pinhole(const core::Rig& rig, std::size_t i) {
  return geometry::pinhole(rig.cameras[i]);
}

// The rig with ideal pinholes in place of cameras that have no distortion of Brown.
core::Rig with_pinholes(core::Rig rig) {
  for (core::Camera& camera : rig.cameras) {
    if (!geometry::is_brown(camera)) camera = ideal_pinhole(camera);
  }
  return rig;
}

bool are_all_brown(const core::Rig& rig) {
  return std::all_of(rig.cameras.begin(), rig.cameras.end(), &geometry::is_brown);
}

cv::Matx33d matrix_of(const PinholeRadtan& c) {
  return {c.fx_px, 0.0, c.cx_px, 0.0, c.fy_px, c.cy_px, 0.0, 0.0, 1.0};
}

cv::Vec<double, 5> distortion_of(const PinholeRadtan& c) { return {c.k1, c.k2, c.p1, c.p2, c.k3}; }

// A rectified pair, before its maps.
struct Layout {
  std::array<cv::Matx33d, 2> turned_from_taken;
  PinholeRadtan camera;  // both
  double baseline_m = 0.0;
};

void require_same_size(const core::Rig& rig) {
  const PinholeRadtan& left = pinhole(rig, 0);
  const PinholeRadtan& right = pinhole(rig, 1);
  if (left.width_px == right.width_px && left.height_px == right.height_px) return;
  throw InputError(fmt::format(
      "rectification: the pictures of the two cameras are {} x {} and {} x {} pixels, expected the "
      "same size",
      left.width_px, left.height_px, right.width_px, right.height_px));
}

Layout layout_of(const core::Rig& rig) {
  require_same_size(rig);
  const PinholeRadtan& left = pinhole(rig, 0);
  const PinholeRadtan& right = pinhole(rig, 1);
  const core::Rigid3 right_from_left = inverse(rig.body_from_camera[1]) * rig.body_from_camera[0];
  const Eigen::Matrix3d columns = right_from_left.rotation.toRotationMatrix();
  const cv::Matx33d rotation = cv::Matx33d(columns.data()).t();
  const cv::Vec3d translation(right_from_left.translation.data());
  constexpr double kMinBaseline_m = 1e-4;
  if (cv::norm(translation) < kMinBaseline_m) {
    throw InputError(fmt::format(
        "rectification: the two cameras are {} m apart, expected two places at least {} m apart",
        cv::norm(translation), kMinBaseline_m));
  }
  if (!(cv::norm(translation) <= geometry::kMaxBaseline_m)) {
    throw InputError(
        fmt::format("rectification: the two cameras are {:.4g} m apart, expected at most {} m",
                    cv::norm(translation), geometry::kMaxBaseline_m));
  }
  Layout layout;
  cv::Matx34d left_projection;
  cv::Matx34d right_projection;
  cv::Matx44d unused;
  constexpr double kNoBlackBorder = 0.0;
  cv::stereoRectify(matrix_of(left), distortion_of(left), matrix_of(right), distortion_of(right),
                    {left.width_px, left.height_px}, rotation, translation,
                    layout.turned_from_taken[0], layout.turned_from_taken[1], left_projection,
                    right_projection, unused, cv::CALIB_ZERO_DISPARITY, kNoBlackBorder);
  layout.camera = {.width_px = left.width_px,
                   .height_px = left.height_px,
                   .fx_px = left_projection(0, 0),
                   .fy_px = left_projection(1, 1),
                   .cx_px = left_projection(0, 2),
                   .cy_px = left_projection(1, 2)};
  layout.baseline_m = -right_projection(0, 3) / right_projection(0, 0);
  return layout;
}

void require_usable(const Layout& layout) {
  if (!(layout.baseline_m > 0.0)) {  // 0: above each other
    throw InputError("rectification: the second camera does not sit to the right of the first");
  }
  for (const cv::Matx33d& turn : layout.turned_from_taken) {
    const double turn_rad = std::acos(std::clamp(0.5 * (cv::trace(turn) - 1.0), -1.0, 1.0));
    constexpr double kMaxTurn_rad = std::numbers::pi / 4.0;
    if (turn_rad <= kMaxTurn_rad && is_centre_inside(layout.camera)) continue;
    throw InputError(
        fmt::format("rectification: a camera would have to be turned by {:.0f} degrees, expected "
                    "at most 45, of two that look the same way beside each other",
                    turn_rad * 180.0 / std::numbers::pi));
  }
}

PixelMap map_of(const core::Camera& taken, const PinholeRadtan& turned,
                const cv::Matx33d& turned_from_taken) {
  if (!geometry::is_brown(taken)) return pixel_map(taken, turned, turned_from_taken);
  const PinholeRadtan& model = geometry::pinhole(taken);
  PixelMap map;
  cv::initUndistortRectifyMap(matrix_of(model), distortion_of(model), turned_from_taken,
                              matrix_of(turned), {turned.width_px, turned.height_px}, CV_32FC1,
                              map.x_px, map.y_px);
  return map;
}

core::Rigid3 turned_back(const cv::Matx33d& turned_from_taken) {
  // row by row is the transpose column by column
  const Eigen::Matrix3d taken_from_turned =
      Eigen::Map<const Eigen::Matrix3d>(turned_from_taken.val);
  return {Eigen::Quaterniond(taken_from_turned), Eigen::Vector3d::Zero()};
}

// Depth along the old optical axis times this is depth along the new one, by pixels of the
// rectified picture: the ray (x, y, 1) of the new camera has another z in the old one.
cv::Mat depth_factors(const Layout& layout) {
  const PinholeRadtan& c = layout.camera;
  const cv::Matx33d& r = layout.turned_from_taken[0];
  cv::Mat factors(c.height_px, c.width_px, CV_32FC1);
  for (int v = 0; v < c.height_px; ++v) {
    for (int u = 0; u < c.width_px; ++u) {
      const double taken_z = r(0, 2) * (u - c.cx_px) / c.fx_px + r(1, 2) * (v - c.cy_px) / c.fy_px +
                             r(2, 2);  // R' ray
      factors.at<float>(v, u) = static_cast<float>(1.0 / taken_z);
    }
  }
  return factors;
}

// What turns the frames of one rig.
class Rectification {
 public:
  explicit Rectification(const core::Rig& taken) : layout_(layout_of(with_pinholes(taken))) {
    require_usable(layout_);
    core::Rig rig = taken;
    rig.cameras = {layout_.camera, layout_.camera};
    rig.body_from_taken_camera = taken.body_from_told_camera();
    rig.body_from_camera[0] = taken.body_from_camera[0] * turned_back(layout_.turned_from_taken[0]);
    const core::Rigid3 left_from_right{Eigen::Quaterniond::Identity(),
                                       {layout_.baseline_m, 0.0, 0.0}};
    rig.body_from_camera[1] = rig.body_from_camera[0] * left_from_right;
    rig_ = std::make_shared<const core::Rig>(rig);
    for (std::size_t i = 0; i < maps_.size(); ++i) {
      maps_[i] = map_of(taken.cameras[i], layout_.camera, layout_.turned_from_taken[i]);
    }
  }

  core::Frame apply(core::Frame frame) {
    for (std::size_t i = 0; i < maps_.size(); ++i) {
      frame.images[i] = maps_[i].apply(frame.images[i], cv::INTER_LINEAR);
    }
    if (frame.depth_m) {
      if (depth_factors_.empty()) depth_factors_ = depth_factors(layout_);
      // between two surfaces there is no depth to interpolate
      frame.depth_m = maps_[0].apply(*frame.depth_m, cv::INTER_NEAREST).mul(depth_factors_);
    }
    frame.rig = rig_;
    return frame;
  }

 private:
  Layout layout_;
  std::shared_ptr<const core::Rig> rig_;
  std::array<PixelMap, 2> maps_;
  cv::Mat depth_factors_;
};

// What turns the pictures of a rig, where one of its cameras is a fisheye or has a rational lens,
// into those of ideal pinholes that look the same way.
class Straightening {
 public:
  explicit Straightening(const core::Rig& taken) {
    core::Rig rig = with_pinholes(taken);
    for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
      maps_.push_back(geometry::is_brown(taken.cameras[i])
                          ? PixelMap{}
                          : pixel_map(taken.cameras[i], pinhole(rig, i), cv::Matx33d::eye()));
    }
    rig_ = std::make_shared<const core::Rig>(std::move(rig));
  }

  core::Frame apply(core::Frame frame) const {
    for (std::size_t i = 0; i < maps_.size(); ++i) {
      if (maps_[i].x_px.empty()) continue;
      frame.images[i] = maps_[i].apply(frame.images[i], cv::INTER_LINEAR);
      // along the optical axis, which stays; between two surfaces there is none to interpolate
      if (i == 0 && frame.depth_m)
        frame.depth_m = maps_[i].apply(*frame.depth_m, cv::INTER_NEAREST);
    }
    frame.rig = rig_;
    return frame;
  }

 private:
  std::shared_ptr<const core::Rig> rig_;
  std::vector<PixelMap> maps_;  // empty: the picture stays as it is
};

class RectifiedSource : public core::Source {
 public:
  explicit RectifiedSource(std::unique_ptr<core::Source> source) : source_(std::move(source)) {}

  core::SourceInfo info() const override { return source_->info(); }
  core::Truth truth() const override { return source_->truth(); }
  core::Trajectory true_trajectory() const override { return source_->true_trajectory(); }

  std::optional<core::Frame> next() override {
    std::optional<core::Frame> frame = source_->next();
    if (!frame) return frame;
    if (frame->id.index() == 0) prepare_for(*frame->rig);
    if (rectification_) return rectification_->apply(*std::move(frame));
    return straightening_ ? straightening_->apply(*std::move(frame)) : frame;
  }

 private:
  void prepare_for(const core::Rig& rig) {
    const bool is_straight = are_all_brown(rig);
    if (rig.cameras.size() == 2 && !(is_straight && core::is_rectified_pair(rig))) {
      rectification_.emplace(rig);
    } else if (!is_straight) {
      straightening_.emplace(rig);
    }
  }

  std::unique_ptr<core::Source> source_;
  // all frames have the rig of the first
  std::optional<Rectification> rectification_;
  std::optional<Straightening> straightening_;
};

}  // namespace

std::unique_ptr<core::Source> rectified(std::unique_ptr<core::Source> source) {
  core::require(source != nullptr, "there is a source to rectify");
  return std::make_unique<RectifiedSource>(std::move(source));
}

}  // namespace samewhere::input
