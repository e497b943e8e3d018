#pragma once

#include <vector>

#include <samewhere/core/rigid3.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::verify {

// Errors of odometry that are the same all along a run, as a wrong wheel radius: they grow with the
// distance, not with its root. Standard deviations; all zero: none.
struct SystematicDrift {
  double per_metre = 0.0;       // metres per metre: all distances are too long or too short
  double rad_per_metre = 0.0;   // the heading turns with the distance
  double rad_per_radian = 0.0;  // all turns are too large or too small
  double rad_per_s = 0.0;       // the heading turns with time
  double tilt_ratio = 1.0;      // of roll and pitch over the heading

  bool is_none() const {
    return per_metre == 0.0 && rad_per_metre == 0.0 && rad_per_radian == 0.0 && rad_per_s == 0.0;
  }
};

// Covariance [m; rad] that they add to the pose of the end of a chain of odometry edges in its
// beginning, for a chain that is made longer at its beginning. The heading is about the axis of the
// largest rotation variance of an edge, if there is one. To first order, and for the position to
// second order in the heading.
class DriftSum {
 public:
  // An error of 1 of distances, of turns, of the heading by distance and by time, and of rotation
  // about each axis of the body by distance and by time.
  static constexpr int kErrors = 10;
  using Effects = Eigen::Matrix<double, 3, kErrors>;  // of each, on the end

  explicit DriftSum(const SystematicDrift& drift) : drift_(drift) {}

  // By the edge from `before` to `here`, the beginning so far. One is the odometry parent of the
  // other.
  void lengthen(const scene::MapVersion& map, core::KeyframeId here, core::KeyframeId before);
  core::Matrix6d covariance() const;

 private:
  SystematicDrift drift_;
  core::Rigid3 end_from_begin_;
  Effects shift_ = Effects::Zero();  // of the position, in the end
  Effects turn_ = Effects::Zero();   // of the rotation, in the end
  double reach_m_ = 0.0;             // of the chain from the end
};

// The same of a whole chain. `path`: from the end back to the beginning, each keyframe the odometry
// parent or the child of the next.
core::Matrix6d systematic_covariance(const scene::MapVersion& map,
                                     const std::vector<core::KeyframeId>& path,
                                     const SystematicDrift& drift);

}  // namespace samewhere::verify
