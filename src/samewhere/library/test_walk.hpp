#pragma once

#include <memory>
#include <vector>

#include <Eigen/LU>

#include <samewhere/core/frame.hpp>
#include <samewhere/library/convert.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/run/open_source.hpp>
#include <samewhere/types.hpp>

namespace samewhere::library {

// A short rendered walk, with a window so short that loops close, even between views that the map
// holds together anyway.
inline std::vector<std::string> test_settings() {
  return {"retrieve.window_frames=4", "map.min_shared=1000",
          "verify.min_look_alike_distance_m=0.3"};
}

inline pipeline::Config test_config(int num_frames) {
  pipeline::Config config = pipeline::load_config("default", {}, test_settings());
  config.source = "twin:office-loop?seed=5";
  config.twin.num_frames = num_frames;
  return config;
}

// The frames of the walk as a user has them: buffers of their own.
struct TestWalk {
  std::vector<core::Frame> frames;
  core::Trajectory truth;
  Calibration calibration;

  Frame at(std::size_t i) const {
    Frame frame{.stamp_s = frames[i].stamp_s, .images = {}, .depth = {}};
    frame.images.push_back(view_of(frames[i].images[0], PixelFormat::kBgr8));
    if (frames[i].depth_m) frame.depth = view_of(*frames[i].depth_m, PixelFormat::kDepthFloat);
    return frame;
  }

  static Image view_of(const cv::Mat& image, PixelFormat format) {
    return {.data = image.data,
            .width_px = image.cols,
            .height_px = image.rows,
            .format = format,
            .stride_bytes = image.step};
  }
};

inline Calibration test_calibration(const core::Frame& frame, double frame_rate_hz) {
  Camera camera = camera_of(frame.rig->cameras[0], frame.images[0].cols, frame.images[0].rows);
  camera.body_from_camera = pose_of(frame.rig->body_from_camera[0]);
  return {.cameras = {camera}, .has_depth = true, .frame_rate_hz = frame_rate_hz};
}

inline TestWalk read_walk(const pipeline::Config& config) {
  const auto source = run::open_source(config);
  TestWalk walk;
  while (auto frame = source->next()) walk.frames.push_back(*frame);
  walk.truth = source->true_trajectory();
  walk.calibration = test_calibration(walk.frames[0], source->info().frame_rate_hz);
  return walk;
}

// Rendered once for all tests of the program.
inline const TestWalk& test_walk() {
  static const TestWalk walk = read_walk(test_config(40));
  return walk;
}

}  // namespace samewhere::library
