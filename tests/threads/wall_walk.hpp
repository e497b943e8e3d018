#pragma once

// A camera that moves along a painted wall and back: nothing is rendered, so that the sanitizers
// take little time.

#include <algorithm>
#include <memory>
#include <vector>

#include <opencv2/core.hpp>

#include <samewhere/core/frame.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/pipeline/config.hpp>

namespace samewhere::pipeline {

inline constexpr int kWidth_px = 240;
inline constexpr int kHeight_px = 180;
inline constexpr int kStep_px = 12;
inline constexpr std::uint64_t kNumFrames = 32;
// In the second of them tracking is lost and has no predicted pose: the whole map is searched.
inline constexpr std::uint64_t kFirstBlackFrame = 21;
inline constexpr std::uint64_t kLastBlackFrame = 22;

// Small images, and a retrieval window so short that loops are closed, even between covisible
// keyframes.
inline Config config_of(bool in_threads) {
  cv::setNumThreads(1);
  Config config;
  config.threads = in_threads;
  config.features.num_features = 300;
  config.map.min_tracked = 60;
  config.retrieve.window_frames = 4;
  config.map.min_shared = 1000;
  return config;
}

inline std::shared_ptr<const core::Rig> rig() {
  core::Rig rig;
  rig.cameras.push_back(core::PinholeRadtan{.width_px = kWidth_px,
                                            .height_px = kHeight_px,
                                            .fx_px = 200.0,
                                            .fy_px = 200.0,
                                            .cx_px = 0.5 * (kWidth_px - 1),
                                            .cy_px = 0.5 * (kHeight_px - 1)});
  rig.body_from_camera.emplace_back();
  return std::make_shared<const core::Rig>(rig);
}

inline cv::Mat painted_wall() {
  core::Random random(3);
  cv::Mat wall(kHeight_px, kWidth_px + kStep_px * static_cast<int>(kNumFrames), CV_8UC3,
               cv::Scalar::all(128));
  for (int i = 0; i < 2000; ++i) {
    const cv::Point corner(static_cast<int>(random.index(static_cast<std::uint64_t>(wall.cols))),
                           static_cast<int>(random.index(kHeight_px)));
    const cv::Size size(4 + static_cast<int>(random.index(16)),
                        4 + static_cast<int>(random.index(16)));
    wall(cv::Rect(corner, size) & cv::Rect({}, wall.size()))
        .setTo(cv::Scalar::all(static_cast<double>(random.index(256))));
  }
  return wall;
}

// Along the wall, 2 m away from it, and back; two frames are black.
inline std::vector<core::Frame> walk() {
  const cv::Mat wall = painted_wall();
  const auto shared_rig = rig();
  std::vector<core::Frame> frames;
  for (std::uint64_t i = 0; i < kNumFrames; ++i) {
    const auto position = static_cast<int>(std::min(i, kNumFrames - i));
    core::Frame frame{.id = core::FrameId(i), .stamp_s = 0.1 * static_cast<double>(i)};
    frame.rig = shared_rig;
    frame.images.push_back(wall(cv::Rect(position * kStep_px, 0, kWidth_px, kHeight_px)).clone());
    if (i >= kFirstBlackFrame && i <= kLastBlackFrame) frame.images[0].setTo(0);
    frame.depth_m = cv::Mat(kHeight_px, kWidth_px, CV_32F, cv::Scalar(2.0));
    frames.push_back(std::move(frame));
  }
  return frames;
}

}  // namespace samewhere::pipeline
