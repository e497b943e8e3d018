#pragma once

#include <string>
#include <vector>

#include <samewhere/core/frame.hpp>
#include <samewhere/core/source.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/run/mapped_slam.hpp>
#include <samewhere/scene/map_file.hpp>

namespace samewhere::run {

// Is told of a run while it goes on, such as a viewer. It copies what it wants to keep, and may let
// the run wait; it changes nothing, so that the results are the same to the bit with and without
// it.
class Watcher {
 public:
  Watcher() = default;
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;
  virtual ~Watcher() = default;

  // Before the first frame.
  virtual void begin(const core::SourceInfo& source, const pipeline::Config& config,
                     bool is_scale_unknown) = 0;
  // After each frame, in the thread that feeds them. `names`: of all frames so far.
  virtual void see_frame(const core::Frame& frame, const std::vector<std::string>& names,
                         const pipeline::Slam& slam) = 0;
  // New pictures of keyframes. In mapping's thread.
  virtual void see_thumbnails(const std::vector<scene::Thumbnail>& thumbnails) = 0;
};

}  // namespace samewhere::run
