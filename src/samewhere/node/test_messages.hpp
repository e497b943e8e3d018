#pragma once

#include <cstring>
#include <string>
#include <vector>

#include <samewhere/library/test_walk.hpp>
#include <samewhere/node/incoming.hpp>
#include <samewhere/node/node.hpp>
#include <samewhere/node/transforms.hpp>

namespace samewhere::node {

// All that a node gave out, in order.
class TestPublisher : public Publisher {
 public:
  void transforms(const messages::TFMessage& message) override { of_transforms.push_back(message); }
  void pose(const messages::PoseWithCovarianceStamped& message) override {
    of_poses.push_back(message);
  }
  void path(const messages::Path& message) override { of_paths.push_back(message); }
  void landmarks(const messages::PointCloud2& message) override { of_landmarks.push_back(message); }
  void grid(const messages::OccupancyGrid& message) override { of_grids.push_back(message); }
  void diagnostics(const messages::DiagnosticArray& message) override {
    for (const auto& status : message.status) of_diagnostics.push_back(status);
  }
  void status(const messages::String& message) override { of_status.push_back(message.data); }

  std::vector<messages::TFMessage> of_transforms;
  std::vector<messages::PoseWithCovarianceStamped> of_poses;
  std::vector<messages::Path> of_paths;
  std::vector<messages::PointCloud2> of_landmarks;
  std::vector<messages::OccupancyGrid> of_grids;
  std::vector<messages::DiagnosticStatus> of_diagnostics;
  std::vector<std::string> of_status;
};

inline constexpr const char* kCameraFrame = "camera_optical";

inline messages::Image image_message(const cv::Mat& image, const std::string& encoding,
                                     double stamp_s) {
  messages::Image message{.header = {messages::time_of(stamp_s), kCameraFrame},
                          .height = static_cast<std::uint32_t>(image.rows),
                          .width = static_cast<std::uint32_t>(image.cols),
                          .encoding = encoding,
                          .step = static_cast<std::uint32_t>(image.step)};
  message.data.assign(image.datastart, image.dataend);
  return message;
}

inline messages::CameraInfo info_message(const Camera& camera) {
  messages::CameraInfo info{.header = {{}, kCameraFrame},
                            .height = static_cast<std::uint32_t>(camera.height_px),
                            .width = static_cast<std::uint32_t>(camera.width_px),
                            .distortion_model = "plumb_bob"};
  info.d = camera.distortion;
  info.d.resize(5);
  info.k = {camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1};
  info.p = {camera.fx_px, 0, camera.cx_px, 0, 0, camera.fy_px, camera.cy_px, 0, 0, 0, 1, 0};
  return info;
}

// The frames of the rendered walk as messages.
struct MessageWalk {
  const library::TestWalk& walk = library::test_walk();

  ImageIn image(std::size_t i) const {
    return {Stream::kFirst, image_message(walk.frames[i].images[0], "bgr8", stamp_s(i))};
  }
  ImageIn depth(std::size_t i) const {
    return {Stream::kSecond, image_message(*walk.frames[i].depth_m, "32FC1", stamp_s(i))};
  }
  CameraInfoIn info() const { return {Stream::kFirst, info_message(walk.calibration.cameras[0])}; }
  double stamp_s(std::size_t i) const { return walk.frames[i].stamp_s; }
  std::size_t size() const { return walk.frames.size(); }
};

// All messages of a walk with depth, in order.
inline void play(Node& node, const MessageWalk& walk) {
  node.take(walk.info());
  for (std::size_t i = 0; i < walk.size(); ++i) {
    node.take(walk.image(i));
    node.take(walk.depth(i));
  }
}

inline Config test_node_config() {
  return {.cameras = Cameras::kDepth,
          .frame_rate_hz = library::test_walk().calibration.frame_rate_hz,
          .never_wait = false,
          .tf_wait_s = 0.0,
          .map_period_s = 0.0};
}

inline Options test_node_options() {
  return {.settings = library::test_settings(), .threads = false};
}

inline messages::TFMessage transform_of(const std::string& parent, const std::string& child,
                                        const Pose& parent_from_child, double stamp_s = 0.0) {
  return {{transform_message(parent, child, stamp_s, parent_from_child)}};
}

}  // namespace samewhere::node
