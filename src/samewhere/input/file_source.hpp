#pragma once

#include <memory>
#include <string>

#include <samewhere/core/source.hpp>
#include <samewhere/input/recording.hpp>

namespace samewhere::input {

// Streams a recording: one frame is read per call of next(), nothing is kept. The first image is
// read once more on construction: its size belongs to the camera.
class FileSource : public core::Source {
 public:
  // Throws InputError if the camera file or the first image is broken, or if the camera's centre
  // lies outside the image (then the calibration belongs to other images).
  FileSource(std::string name, Recording recording);

  core::SourceInfo info() const override;
  std::optional<core::Frame> next() override;
  core::Truth truth() const override { return recording_.truth; }

 private:
  core::SourceInfo info_;
  Recording recording_;
  std::shared_ptr<const core::Rig> rig_;
  int width_px_ = 0;
  int height_px_ = 0;
  std::size_t next_index_ = 0;
};

}  // namespace samewhere::input
