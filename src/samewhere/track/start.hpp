#pragma once

#include <cstdint>
#include <vector>

#include <samewhere/core/result.hpp>
#include <samewhere/core/rigid3.hpp>
#include <samewhere/features/config.hpp>
#include <samewhere/features/features.hpp>
#include <samewhere/features/match_pair.hpp>
#include <samewhere/optimize/config.hpp>
#include <samewhere/track/config.hpp>
#include <samewhere/track/two_view_model.hpp>

namespace samewhere::track {

// What two views of one camera say about its motion and about the points that both see. The scale
// is free: the median depth of the points in the first camera is 1.
struct Start {
  core::Rigid3 first_from_second;                           // camera 0 of either view
  core::Matrix6d information = core::Matrix6d::Identity();  // of the second body in the first,
                                                            // odometry_information()
  std::vector<features::Match> matches;          // first and second: the features that show a point
  std::vector<Eigen::Vector3d> points_in_first;  // one per match, in the first camera
  double median_parallax_rad = 0.0;              // of all matches that agree with the motion
  bool is_planar = false;                        // found by a homography
};

struct StartSettings {
  InitializationConfig start;
  DriftConfig drift;
  features::Config features;
  optimize::Config optimize;
  std::uint64_t seed = 0;
};

// The motion between two views without depth: of the motions behind their model
// (two_view_model.hpp) the one that puts most matches in front of both cameras, refined on these.
// Refused: views without a model, a motion without parallax (a rotation says nothing of depth), a
// motion that a second one explains nearly as well, too few matches or points. Both views are
// calibrated, else ContractError.
Result<Start, NoStart> try_start(const features::View& first, const features::View& second,
                                 const StartSettings& settings);

}  // namespace samewhere::track
