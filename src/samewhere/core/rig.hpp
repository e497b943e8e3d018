#pragma once

#include <optional>
#include <variant>
#include <vector>

#include <samewhere/core/rigid3.hpp>

namespace samewhere::core {

// Pinhole camera with the radial-tangential distortion of Brown (OpenCV's order k1 k2 p1 p2 k3) and
// the denominator of OpenCV's rational model (k4 k5 k6; 0: there is none). Lengths in pixels; the
// centre of the upper left pixel is (0, 0). The functions on it are in geometry/camera.hpp.
struct PinholeRadtan {
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
  double k1 = 0.0;
  double k2 = 0.0;
  double p1 = 0.0;
  double p2 = 0.0;
  double k3 = 0.0;
  double k4 = 0.0;
  double k5 = 0.0;
  double k6 = 0.0;
};

// Fisheye camera of Kannala and Brandt 2006 as OpenCV, Kalibr (equidistant) and ORB-SLAM3 have it:
// a ray at the angle t from the optical axis appears f t (1 + k1 t^2 + k2 t^4 + k3 t^6 + k4 t^8)
// from the centre. Lengths in pixels, centre of the upper left pixel (0, 0).
struct KannalaBrandt {
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
  double k1 = 0.0;
  double k2 = 0.0;
  double k3 = 0.0;
  double k4 = 0.0;
};

// Behind input/rectify.hpp every camera is a PinholeRadtan without k4 k5 k6: pictures of the other
// models have been turned into those of an ideal pinhole.
using Camera = std::variant<PinholeRadtan, KannalaBrandt>;

// Extrinsic calibration and noise model of an inertial unit: densities of the white noise and of
// the random walk of the biases; 0: not known.
struct Imu {
  Rigid3 body_from_imu;
  double gyroscope_noise_rad_s_sqrt_hz = 0.0;
  double accelerometer_noise_m_s2_sqrt_hz = 0.0;
  double gyroscope_bias_walk_rad_s2_sqrt_hz = 0.0;
  double accelerometer_bias_walk_m_s3_sqrt_hz = 0.0;
};

// The sensors of one body. Poses are body poses; camera i hangs on it by body_from_camera[i]. No
// camera means that the calibration is unknown: recognition works then, poses do not.
struct Rig {
  std::vector<Camera> cameras;
  std::vector<Rigid3> body_from_camera;
  // Camera 0 before rectification rotated its images; none: not rectified, body_from_camera[0]
  // holds.
  std::optional<Rigid3> body_from_taken_camera;
  std::optional<Imu> imu;

  bool is_calibrated() const { return !cameras.empty(); }
  // Extrinsics of camera 0 as its poses are exported. Requires a camera.
  const Rigid3& body_from_told_camera() const {
    return body_from_taken_camera ? *body_from_taken_camera : body_from_camera.front();
  }
};

}  // namespace samewhere::core
