#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <samewhere/core/similarity.hpp>
#include <samewhere/scene/map_values.hpp>

namespace samewhere::scene {
namespace {

// The largest side that a JPEG can have, and more pixels than any sensor has.
constexpr int kMaxSide_px = 65535;
constexpr int kMaxPixels = 1 << 28;
// Of a pixel that an ideal pinhole would see, or a very near point in the right picture: squares of
// it are still finite in single precision.
constexpr float kMaxPixel_px = 1e9F;
// Metres, or the lengths of a map without depth. Fourth powers of it are still numbers.
constexpr double kMaxLength = 1e15;
// Of a factor between lengths: a map that is stretched so far is none.
constexpr double kMaxLogScale = 50.0;
// Of the pyramid: features.num_levels goes to 12.
constexpr int kMaxOctave = 31;
// Standard deviations are between 1e-10 and 1e10 of a metre or radian.
constexpr double kMaxInformation = 1e20;
// A correlation nearer to 1 cannot be inverted in double precision.
constexpr double kMinEigenvalue = 1e-13;
constexpr double kMaxFocal_px = 1e7;
constexpr double kMaxDistortion = 1e6;
// Sessions are counted on: a later one is numbered after all of them, and its frames come last.
constexpr std::uint16_t kMaxSession = 32000;

// The first complaint of several.
using Check = std::pair<bool, const char*>;

const char* first_complaint(std::initializer_list<Check> checks) {
  for (const auto& [is_fine, complaint] : checks)
    if (!is_fine) return complaint;
  return nullptr;
}

// false on NaN
bool is_length(double length) { return length >= 0.0 && length <= kMaxLength; }

bool is_position(const Eigen::Vector3d& position) {
  return position.allFinite() && position.cwiseAbs().maxCoeff() <= kMaxLength;
}

bool is_pose(const core::Rigid3& a_from_b) {
  constexpr double kTolerance = 1e-6;
  return std::abs(a_from_b.rotation.norm() - 1.0) <= kTolerance &&
         is_position(a_from_b.translation);
}

bool is_pose(const std::optional<core::Rigid3>& a_from_b) {
  return !a_from_b || is_pose(*a_from_b);
}

bool is_log_scale(double log_scale) { return std::abs(log_scale) <= kMaxLogScale; }

// Symmetric, and positive definite by what is left when every unknown is measured in its own unit.
bool is_information(const core::Matrix6d& information) {
  constexpr double kTolerance = 1e-6;
  const core::Vector6d diagonal = information.diagonal();
  if (!information.allFinite() || diagonal.minCoeff() < 1.0 / kMaxInformation ||
      diagonal.maxCoeff() > kMaxInformation)
    return false;
  const core::Vector6d units = diagonal.cwiseSqrt().cwiseInverse();
  const core::Matrix6d correlation = units.asDiagonal() * information * units.asDiagonal();
  if ((correlation - correlation.transpose()).cwiseAbs().maxCoeff() > kTolerance) return false;
  const Eigen::SelfAdjointEigenSolver<core::Matrix6d> solver(correlation, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().minCoeff() >= kMinEigenvalue;
}

bool is_frame(core::FrameId frame) {
  return frame.session() <= kMaxSession && frame.index() <= core::FrameId::kMaxIndex;
}

// Pictures of the other models are those of an ideal pinhole by then (core/rig.hpp).
bool is_camera(const core::Camera& camera) {
  const auto* pinhole = std::get_if<core::PinholeRadtan>(&camera);
  if (pinhole == nullptr) return false;
  const core::PinholeRadtan& c = *pinhole;
  const auto is_side = [](int side_px) { return side_px >= 0 && side_px <= kMaxSide_px; };
  const auto is_focal = [](double focal_px) { return focal_px > 0.0 && focal_px <= kMaxFocal_px; };
  const auto is_centre = [](double px) { return std::abs(px) <= kMaxFocal_px; };
  const auto coefficients = {c.k1, c.k2, c.p1, c.p2, c.k3};
  return is_side(c.width_px) && is_side(c.height_px) && is_focal(c.fx_px) && is_focal(c.fy_px) &&
         is_centre(c.cx_px) && is_centre(c.cy_px) && c.k4 == 0.0 && c.k5 == 0.0 && c.k6 == 0.0 &&
         std::ranges::all_of(coefficients, [](double k) { return std::abs(k) <= kMaxDistortion; });
}

bool is_imu(const core::Imu& imu) {
  const auto densities = {imu.gyroscope_noise_rad_s_sqrt_hz, imu.accelerometer_noise_m_s2_sqrt_hz,
                          imu.gyroscope_bias_walk_rad_s2_sqrt_hz,
                          imu.accelerometer_bias_walk_m_s3_sqrt_hz};
  return is_pose(imu.body_from_imu) && std::ranges::all_of(densities, is_length);
}

bool have_one_length(const features::Features& f) {
  const std::size_t size = f.raw_px.size();
  return f.undistorted_px.size() == size && f.depth_m.size() == size &&
         f.right_x_px.size() == size && f.octave.size() == size && f.angle_rad.size() == size &&
         f.rgb.size() == size && f.descriptors.rows == f.size() &&
         (size == 0 || f.descriptors.cols == 32);
}

bool is_octave(int octave) { return octave >= 0 && octave <= kMaxOctave; }

// Inside the picture, half a pixel around the outermost centres.
bool are_inside(const features::Array<Eigen::Vector2f>& pixels, const cv::Size& size_px) {
  return std::ranges::all_of(pixels, [&](const Eigen::Vector2f& pixel) {
    return pixel.x() >= -0.5F && pixel.y() >= -0.5F &&
           pixel.x() <= static_cast<float>(size_px.width) &&
           pixel.y() <= static_cast<float>(size_px.height);
  });
}

const char* complaint_on(const features::Features& f, const cv::Size& size_px) {
  return first_complaint({
      {have_one_length(f), "has lists of features of different lengths"},
      {are_inside(f.raw_px, size_px), "has a feature outside its picture"},
      {std::ranges::all_of(f.undistorted_px,
                           [](const Eigen::Vector2f& pixel) {
                             return pixel.allFinite() &&
                                    pixel.cwiseAbs().maxCoeff() <= kMaxPixel_px;
                           }),
       "has an undistorted feature that no camera sees"},
      {std::ranges::all_of(f.depth_m, [](float depth_m) { return is_length(depth_m); }),
       "has a depth that is none"},
      {std::ranges::all_of(
           f.right_x_px,
           [](float x_px) { return std::isnan(x_px) || std::abs(x_px) <= kMaxPixel_px; }),
       "has a feature in its right picture that no camera sees"},
      {std::ranges::all_of(f.octave, is_octave), "has a feature of a level that no pyramid has"},
      {std::ranges::all_of(f.angle_rad, [](float angle) { return std::abs(angle) <= 100.0F; }),
       "has an angle that is none"},
  });
}

}  // namespace

const char* complaint_on(const core::Rig& rig) {
  return first_complaint({
      {rig.is_calibrated(), "has no camera"},
      {rig.cameras.size() == rig.body_from_camera.size(),
       "has another number of cameras than of their poses"},
      {std::ranges::all_of(rig.cameras, is_camera), "has a camera that no lens can have"},
      {std::ranges::all_of(rig.body_from_camera,
                           [](const core::Rigid3& pose) { return is_pose(pose); }),
       "has a camera whose pose is none"},
      {!rig.body_from_taken_camera || is_pose(*rig.body_from_taken_camera),
       "has a camera whose pose before it was turned is none"},
      {!rig.imu || is_imu(*rig.imu), "has an inertial unit that none can be"},
  });
}

const char* complaint_on(const features::View& view) {
  const cv::Size& size_px = view.image_size_px;
  const auto is_side = [](int side_px) { return side_px > 0 && side_px <= kMaxSide_px; };
  const char* complaint = first_complaint({
      {is_frame(view.frame), "is of a frame that no session has"},
      {std::isfinite(view.stamp_s), "has a time stamp that is none"},
      {is_side(size_px.width) && is_side(size_px.height) &&
           size_px.height <= kMaxPixels / size_px.width,
       "has a picture of a size that none has"},
  });
  return complaint != nullptr ? complaint : complaint_on(*view.features, size_px);
}

const char* complaint_on(const Keyframe& keyframe) {
  const bool is_odometry = !keyframe.odometry || is_pose(keyframe.odometry->parent_from_keyframe);
  return first_complaint({
      {is_pose(keyframe.world_from_body), "has a pose that is none"},
      {is_odometry && is_pose(keyframe.refined_parent_from_keyframe) &&
           is_pose(keyframe.settled_parent_from_keyframe) &&
           is_pose(keyframe.culled_parent_from_keyframe),
       "has a pose relative to its parent that is none"},
      {!keyframe.odometry || is_information(keyframe.odometry->information),
       "has an information matrix that is not positive definite"},
      {is_log_scale(keyframe.log_scale), "has a scale that is none"},
  });
}

const char* complaint_on(const Landmark& landmark) {
  constexpr double kMaxNormal = 1.0 + 1e-6;
  constexpr double kMaxWeight = 1e30;  // of depths of less than a micrometre
  return first_complaint({
      {is_position(landmark.position_in_anchor), "has a position that is none"},
      {landmark.normal_in_anchor.norm() <= kMaxNormal, "has a normal that is no unit vector"},
      {is_length(landmark.range_m), "has a range that is none"},
      {is_octave(landmark.octave), "has a level that no pyramid has"},
      {landmark.weight >= 0.0 && landmark.weight <= kMaxWeight, "has a weight that is none"},
  });
}

const char* complaint_on(const LoopEdge& loop) {
  return first_complaint({
      {is_pose(loop.match_from_query), "has a relative pose that is none"},
      {is_information(loop.information), "has an information matrix that is not positive definite"},
      {loop.cause.is_valid(), "has no cause"},
      {is_log_scale(loop.log_scale), "has a scale that is none"},
  });
}

const char* complaint_on(const core::FramePose& pose) {
  const auto status = static_cast<int>(pose.status);
  return first_complaint({
      {is_frame(pose.frame), "is of a frame that no session has"},
      {std::isfinite(pose.stamp_s), "has a time stamp that is none"},
      {status >= 0 && status <= static_cast<int>(core::kLastStatus), "has a status that is none"},
      {is_pose(pose.reference_from_frame), "has a pose that is none"},
      {is_information(pose.information), "has an information matrix that is not positive definite"},
      {pose.num_inliers >= 0, "has fewer inliers than none"},
      {is_log_scale(pose.log_scale), "has a scale that is none"},
  });
}

const char* complaint_on(const core::Descriptor& descriptor) {
  return first_complaint({
      {is_frame(descriptor.frame), "is of a frame that no session has"},
      {!descriptor.unit.empty() && core::is_unit_or_zero(descriptor.unit),
       "is no vector of length 1"},
  });
}

}  // namespace samewhere::scene
