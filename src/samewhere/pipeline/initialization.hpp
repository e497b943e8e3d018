#pragma once

#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <samewhere/core/frame_pose.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/pipeline/messages.hpp>
#include <samewhere/pipeline/session.hpp>
#include <samewhere/track/starter.hpp>

namespace samewhere::pipeline {

// What a map begins with.
struct InitialViews {
  ToMapping message;  // StartMap or StartMapByMotion
  int num_landmarks = 0;
  std::vector<features::View> skipped;  // monocular: frames between both views, without a pose
};

// The first views of a map: with depth one view, monocular two with enough parallax
// (track/starter.hpp).
class Initialization {
 public:
  Initialization(const Config& config, DepthFrom depth_from);

  bool is_monocular() const { return starter_.has_value(); }
  // Tries to begin a map with the view; nothing: not yet. `image`: of the view.
  std::optional<InitialViews> try_view(const features::View& view, const cv::Mat& image);
  // The earlier view of a monocular pair is dropped.
  void reset();

  // What the view lacks, while there is no map.
  core::FrameStatus waiting_status(const features::View& view) const;
  // Why the last views that were tried did not begin a map, in words.
  std::string why_not() const;

 private:
  std::optional<InitialViews> try_pair(const features::View& view, const cv::Mat& image);

  map::Config config_;
  std::optional<track::Starter> starter_;  // monocular
  int num_features_ = 0;                   // of the last view that was tried
  int num_with_depth_ = 0;                 // of these
};

}  // namespace samewhere::pipeline
