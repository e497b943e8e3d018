#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace samewhere {

/// The layout of poses, which -march options would change.
static_assert(EIGEN_MAX_ALIGN_BYTES == 16,
              "compile with -DEIGEN_MAX_ALIGN_BYTES=16, as libsamewhere is");

/// a_from_b: takes a point in b to the same point in a. Metres; without depth or a second camera
/// the unit of the map.
using Pose = Eigen::Isometry3d;

/// Of a pose, tangent order [translation (m); rotation (rad)].
using Covariance = Eigen::Matrix<double, 6, 6>;

/// How a pixel is stored. Depth is along the optical axis; 0, NaN and infinity: unknown.
enum class PixelFormat {
  kGray8,      ///< 1 byte
  kBgr8,       ///< 3 bytes
  kRgb8,       ///< 3 bytes
  kBgra8,      ///< 4 bytes; the last one is not used
  kDepth16,    ///< unsigned 16 bits, in units of Image::depth_units_per_m
  kDepthFloat  ///< 32-bit float, metres
};

/// A view of height_px x width_px pixels that the caller owns, row by row. They are copied before
/// the call that takes the image returns.
struct Image {
  const void* data = nullptr;                ///< first pixel of the upper row
  int width_px = 0;                          ///< pixels of a row
  int height_px = 0;                         ///< rows
  PixelFormat format = PixelFormat::kGray8;  ///< of each pixel
  std::size_t stride_bytes = 0;              ///< from row to row; 0: rows have no gap
  double depth_units_per_m = 1000.0;         ///< of kDepth16
};

/// Sensor data of one moment.
struct Frame {
  double stamp_s = 0.0;        ///< seconds on any clock; rises from frame to frame
  std::vector<Image> images;   ///< one per camera
  std::optional<Image> depth;  ///< of camera 0, the same size
};

/// The distortion model, with the order of Camera::distortion.
enum class Lens {
  kRadialTangential,  ///< k1 k2 p1 p2 [k3 [k4 k5 k6]] (Brown, OpenCV)
  kFisheye            ///< k1 k2 k3 k4 (Kannala and Brandt 2006)
};

/// A pinhole camera with distortion. The centre of the upper left pixel is (0, 0); the camera looks
/// along z, x is right, y is down.
struct Camera {
  int width_px = 0;                          ///< of its images
  int height_px = 0;                         ///< of its images
  double fx_px = 0.0;                        ///< focal length along x
  double fy_px = 0.0;                        ///< focal length along y
  double cx_px = 0.0;                        ///< principal point, x
  double cy_px = 0.0;                        ///< principal point, y
  Lens lens = Lens::kRadialTangential;       ///< what `distortion` means
  std::vector<double> distortion;            ///< coefficients in the order of `lens`; empty: none
  Pose body_from_camera = Pose::Identity();  ///< extrinsic calibration, metres
};

/// The sensors of a session, which do not change in it.
struct Calibration {
  std::vector<Camera> cameras;  ///< one, or the left and the right one of a stereo pair
  bool has_depth = false;       ///< whether frames come with depth
  double frame_rate_hz = 30.0;  ///< of the frames given: turns times of the settings into frames
};

/// A camera file of any format that `samewhere run --camera` reads, for images of this size. Throws
/// InputError if the file cannot be used.
Camera read_camera(const std::filesystem::path& file, int width_px, int height_px);

/// The place prior: what is known of the surroundings.
enum class Prior {
  kRepetitive,  ///< two places may look alike: appearance alone accepts no loop
  kUnique       ///< no two places look alike
};

}  // namespace samewhere
