#pragma once

#include <memory>
#include <optional>

#include <samewhere/core/frame.hpp>
#include <samewhere/core/source.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/types.hpp>

namespace samewhere::library {

// Frames of the library's interface as frames of the program: checked, copied, rectified and
// enlarged, as a recording's are. Numbered from 0.
class FrameIntake {
 public:
  // Throws core::InputError on numbers that are no calibration.
  FrameIntake(const Calibration& calibration, const pipeline::Config& config);
  FrameIntake(const FrameIntake&) = delete;
  FrameIntake& operator=(const FrameIntake&) = delete;
  ~FrameIntake();

  core::SourceInfo info() const;
  bool is_without_scale() const;  // one camera, no depth

  // Throws core::InputError for a frame that does not fit the calibration, or whose stamp is not
  // above the last.
  void check(const Frame& frame) const;
  // A frame that was checked. Throws core::InputError if the cameras cannot be rectified; then no
  // frame may follow.
  core::Frame take(const Frame& frame);

 private:
  class Given;
  Given* given_ = nullptr;  // part of source_
  std::unique_ptr<core::Source> source_;
};

}  // namespace samewhere::library
