#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace samewhere {

// The layout of poses, which -march options would change.
static_assert(EIGEN_MAX_ALIGN_BYTES == 16,
              "compile with -DEIGEN_MAX_ALIGN_BYTES=16, as libsamewhere is");

// a_from_b: takes a point in b to the same point in a. Metres; without depth or a second camera the
// unit of the map.
using Pose = Eigen::Isometry3d;

// Of a pose, tangent order [translation (m); rotation (rad)].
using Covariance = Eigen::Matrix<double, 6, 6>;

// kDepth16: depth units, see Image::depth_units_per_m. kDepthFloat: metres. Depth is along the
// optical axis; 0, NaN and infinity: unknown.
enum class PixelFormat { kGray8, kBgr8, kRgb8, kBgra8, kDepth16, kDepthFloat };

// A view of pixels that the caller owns, row by row. They are copied before the call that takes the
// image returns.
struct Image {
  const void* data = nullptr;
  int width_px = 0;
  int height_px = 0;
  PixelFormat format = PixelFormat::kGray8;
  std::size_t stride_bytes = 0;       // from row to row; 0: rows have no gap
  double depth_units_per_m = 1000.0;  // of kDepth16
};

// Sensor data of one moment.
struct Frame {
  double stamp_s = 0.0;        // rises from frame to frame
  std::vector<Image> images;   // one per camera
  std::optional<Image> depth;  // of camera 0, the same size
};

// kRadialTangential: k1 k2 p1 p2 [k3 [k4 k5 k6]] (Brown, OpenCV). kFisheye: k1 k2 k3 k4 (Kannala
// and Brandt 2006).
enum class Lens { kRadialTangential, kFisheye };

// Pixels; the centre of the upper left pixel is (0, 0).
struct Camera {
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
  Lens lens = Lens::kRadialTangential;
  std::vector<double> distortion;  // empty: none
  Pose body_from_camera = Pose::Identity();
};

struct Calibration {
  std::vector<Camera> cameras;  // one, or the left and the right one of a stereo pair
  bool has_depth = false;       // whether frames come with depth
  double frame_rate_hz = 30.0;  // of the frames given: turns times of the settings into frames
};

// A camera file of any format that `samewhere run --camera` reads, for images of this size. Throws
// InputError.
Camera read_camera(const std::filesystem::path& file, int width_px, int height_px);

// The place prior. kRepetitive: two places may look alike, so that appearance alone accepts no
// loop. kUnique: no two places do.
enum class Prior { kRepetitive, kUnique };

}  // namespace samewhere
