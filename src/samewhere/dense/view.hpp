#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include <samewhere/core/rig.hpp>
#include <samewhere/dense/config.hpp>

namespace samewhere::dense {

// One picture with its depth and where it was taken from.
struct View {
  core::Camera camera;
  core::Rigid3 world_from_camera;
  cv::Mat image;    // 8-bit grey or BGR, rows x columns
  cv::Mat depth_m;  // 32-bit float, same size, metres along the optical axis; 0: unknown
};

// A point of a surface as one picture shows it.
struct SeenPoint {
  Eigen::Vector3f in_camera = Eigen::Vector3f::Zero();
  Eigen::Vector3f in_world = Eigen::Vector3f::Zero();
  std::array<std::uint8_t, 3> rgb{};
};

// Turns depth images into points. Remembers the directions of the last camera's pixels, because
// undoing a lens for each is slow.
class PointReader {
 public:
  explicit PointReader(const Config& config) : config_(config) {}

  // The points of every config.step_px-th row and column whose depth is known (a finite number
  // from min_depth_m to max_depth_m) and that lie on no edge: beside a jump in depth, sensors
  // report depths between the two surfaces where nothing is. In the order of rows. Image and depth
  // must have the camera's size.
  std::vector<SeenPoint> points(const View& view);
  // The same points in the axes of the camera, without an image. `depth_m` as in a View.
  std::vector<Eigen::Vector3f> points_in_camera(const core::Camera& camera, const cv::Mat& depth_m);

 private:
  // Calls use(in_camera, row, column) for each point.
  template <class Use>
  void visit(const core::Camera& camera, const cv::Mat& depth_m, const Use& use);
  void remember_rays(const core::Camera& camera);
  bool is_usable(float depth_m) const;
  bool is_on_edge(const cv::Mat& depth_m, int row, int column) const;

  Config config_;
  core::PinholeRadtan camera_;
  std::vector<Eigen::Vector3f> rays_;  // of the used pixels, row by row, at depth 1
};

}  // namespace samewhere::dense
