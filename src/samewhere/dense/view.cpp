#include <cmath>

#include <opencv2/core.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/dense/view.hpp>
#include <samewhere/geometry/camera.hpp>

namespace samewhere::dense {
namespace {

bool is_same(const core::PinholeRadtan& a, const core::PinholeRadtan& b) {
  return a.width_px == b.width_px && a.height_px == b.height_px && a.fx_px == b.fx_px &&
         a.fy_px == b.fy_px && a.cx_px == b.cx_px && a.cy_px == b.cy_px && a.k1 == b.k1 &&
         a.k2 == b.k2 && a.p1 == b.p1 && a.p2 == b.p2 && a.k3 == b.k3;
}

std::array<std::uint8_t, 3> colour_at(const cv::Mat& image, int row, int column) {
  if (image.channels() == 1) {
    const std::uint8_t grey = image.at<std::uint8_t>(row, column);
    return {grey, grey, grey};
  }
  const auto& bgr = image.at<cv::Vec3b>(row, column);
  return {bgr[2], bgr[1], bgr[0]};
}

}  // namespace

void PointReader::remember_rays(const core::Camera& camera) {
  const core::PinholeRadtan& pinhole = geometry::pinhole(camera);
  if (!rays_.empty() && is_same(camera_, pinhole)) return;
  camera_ = pinhole;
  rays_.clear();
  for (int row = 0; row < pinhole.height_px; row += config_.step_px) {
    for (int column = 0; column < pinhole.width_px; column += config_.step_px) {
      const Eigen::Vector3d bearing = geometry::bearing(camera, {column, row});
      rays_.emplace_back((bearing / bearing.z()).cast<float>());
    }
  }
}

bool PointReader::is_usable(float depth_m) const {
  return depth_m >= config_.min_depth_m && depth_m <= config_.max_depth_m;  // false for NaN
}

bool PointReader::is_on_edge(const cv::Mat& depth_m, int row, int column) const {
  constexpr std::array<std::array<int, 2>, 4> kNeighbours = {{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
  const float here_m = depth_m.at<float>(row, column);
  for (const auto& [down, right] : kNeighbours) {
    const int r = row + down;
    const int c = column + right;
    if (r < 0 || c < 0 || r >= depth_m.rows || c >= depth_m.cols) continue;
    const float there_m = depth_m.at<float>(r, c);
    if (there_m > 0.0F && std::abs(there_m - here_m) > config_.max_jump_ratio * here_m) return true;
  }
  return false;
}

template <class Use>
void PointReader::visit(const core::Camera& camera, const cv::Mat& depth_m, const Use& use) {
  remember_rays(camera);
  const cv::Size size(camera_.width_px, camera_.height_px);
  core::require(depth_m.size() == size && depth_m.type() == CV_32FC1,
                "depth is 32-bit float and as large as the camera's picture");
  auto ray = rays_.begin();
  for (int row = 0; row < size.height; row += config_.step_px) {
    for (int column = 0; column < size.width; column += config_.step_px, ++ray) {
      const float here_m = depth_m.at<float>(row, column);
      if (!is_usable(here_m) || is_on_edge(depth_m, row, column)) continue;
      use(Eigen::Vector3f(here_m * *ray), row, column);
    }
  }
}

std::vector<SeenPoint> PointReader::points(const View& view) {
  core::require(view.image.size() == view.depth_m.size() && view.image.depth() == CV_8U,
                "the image has 8 bits and the size of the camera's picture");
  const Eigen::Matrix3f rotation = view.world_from_camera.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f translation = view.world_from_camera.translation.cast<float>();
  std::vector<SeenPoint> points;
  visit(view.camera, view.depth_m, [&](const Eigen::Vector3f& in_camera, int row, int column) {
    points.push_back(
        {in_camera, rotation * in_camera + translation, colour_at(view.image, row, column)});
  });
  return points;
}

std::vector<Eigen::Vector3f> PointReader::points_in_camera(const core::Camera& camera,
                                                           const cv::Mat& depth_m) {
  std::vector<Eigen::Vector3f> points;
  visit(camera, depth_m, [&](const Eigen::Vector3f& in_camera, int /*row*/, int /*column*/) {
    points.push_back(in_camera);
  });
  return points;
}

}  // namespace samewhere::dense
