#pragma once

#include <vector>

#include <samewhere/core/frame.hpp>
#include <samewhere/core/ledger.hpp>
#include <samewhere/core/source.hpp>
#include <samewhere/features/features.hpp>
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

  // SLAM, before the first frame. Called again where a further session begins: what came before is
  // over. A live source does not wait.
  virtual void begin(const core::SourceInfo& source, const pipeline::Config& config,
                     bool is_scale_unknown) = 0;
  // After each frame, in the thread that feeds them.
  virtual void see_frame(const core::Frame& frame, const pipeline::Slam& slam) = 0;

  // Recognition alone, before the first frame.
  virtual void begin_recognition(const core::SourceInfo& source,
                                 const pipeline::Config& config) = 0;
  // After each frame, in the thread of the run: `rows` are the verdicts told with it, on candidates
  // of this frame or older ones.
  virtual void see_judged_frame(const core::Frame& frame, const features::View& view,
                                const core::Ledger& rows) = 0;

  // New pictures of keyframes, in mapping's thread; in recognition of the frames of candidates.
  virtual void see_thumbnails(const std::vector<scene::Thumbnail>& thumbnails) = 0;
};

// The plan with the watcher, if any, being told of pictures of keyframes.
MapPlan watched(MapPlan plan, Watcher* watcher);

}  // namespace samewhere::run
