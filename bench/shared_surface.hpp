#pragma once

#include <vector>

#include <Eigen/Core>

#include "carried_pixels.hpp"
#include <samewhere/core/rig.hpp>
#include <samewhere/evaluate/precision_recall.hpp>

namespace samewhere::bench {

// What a frame shows, as far as its depth is known.
struct SurfaceView {
  int frame = 0;
  DepthView seen;
  std::vector<Eigen::Vector3d> coarse;  // points of it, in the camera: some, on a grid
  std::vector<Eigen::Vector3d> fine;    // many
};

// `depth_m`: 32-bit float, 0 where it is not known. Its pose is the caller's to set.
SurfaceView surface_view(int frame, const cv::Mat& depth_m, const core::Camera& camera);

struct SharedSurface {
  double share = 0.0;       // the smaller one of what either view shows that the other sees
  double likeliness = 0.0;  // in [0, 1]: that pr-v2 calls them the same place, poses being rough
};

// By the rule that the truth of pr-v2 is made with (docs/evaluation.md): a point is seen if the
// other view sees something there that is as deep. Of the coarse points, or of the fine ones.
SharedSurface shared_surface(const SurfaceView& a, const SurfaceView& b, const core::Camera& camera,
                             std::vector<Eigen::Vector3d> SurfaceView::*points);

// Of each view the one, more than the window before it, that most likely shows the same place; its
// score is the share. Views in the order of their frames; without any that shares something there
// is no row.
std::vector<evaluate::Match> places_by_surface(const std::vector<SurfaceView>& views,
                                               const core::Camera& camera, int window_frames);

}  // namespace samewhere::bench
