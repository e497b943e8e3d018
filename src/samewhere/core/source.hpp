#pragma once

#include <optional>
#include <string>

#include <samewhere/core/frame.hpp>
#include <samewhere/core/truth.hpp>

namespace samewhere::core {

struct SourceInfo {
  std::string name;        // short, for output folders and titles
  std::string format;      // "TUM RGB-D", "7-Scenes", ...
  int num_frames = 0;      // how many next() will give; 0: unknown
  bool has_depth = false;  // whether any frame comes with depth
  int num_cameras = 1;     // images of a frame
  bool is_calibrated = false;
  bool is_live = false;        // a camera: frames come whether they are asked for or not
  bool is_video = false;       // a file that may be played as if it were live
  double frame_rate_hz = 0.0;  // 1 / median time between frames; 0 for a single frame
};

// A stream of frames in the order of time. Implementations: input/ (files), twin/ (rendered).
class Source {
 public:
  Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
  virtual ~Source() = default;

  virtual SourceInfo info() const = 0;
  // The next frame, or nothing at the end. Frame ids count from 0 without gaps. Throws InputError
  // on a bad frame.
  virtual std::optional<Frame> next() = 0;
  // Ground truth that came with the frames. Throws InputError if it is there but broken.
  virtual Truth truth() const = 0;
  // Its trajectory alone, for which nothing else has to be worked out. Throws as truth() does.
  virtual Trajectory true_trajectory() const { return truth().trajectory; }
};

}  // namespace samewhere::core
