#pragma once

#include <memory>
#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

#include <samewhere/core/source.hpp>
#include <samewhere/input/recording.hpp>

namespace samewhere::input {

// Streams a recording: one frame is read per call of next(), nothing is kept. The first image of
// each camera is read once more on construction: its size belongs to the camera. A frame carries
// the inertial samples after the frame before it, up to its own stamp; the first all up to there.
// Warns in the log, with the first depth, where a handful of depth pictures from the whole
// recording contradict their units (depth_check.hpp).
class FileSource : public core::Source {
 public:
  // Throws InputError if the camera file or a first image is broken, or if the calibration belongs
  // to other images: the camera's centre lies outside, or the size is another one.
  FileSource(std::string name, Recording recording);

  core::SourceInfo info() const override;
  std::optional<core::Frame> next() override;
  core::Truth truth() const override { return recording_.truth; }

 private:
  core::SourceInfo info_;
  Recording recording_;
  std::shared_ptr<const core::Rig> rig_;
  std::vector<cv::Size> sizes_px_;  // one per camera
  std::size_t next_index_ = 0;
  std::size_t next_imu_ = 0;
  bool is_depth_checked_ = false;
};

}  // namespace samewhere::input
