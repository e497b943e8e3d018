#pragma once

#include <optional>
#include <vector>

#include <samewhere/core/ids.hpp>
#include <samewhere/core/rigid3.hpp>
#include <samewhere/geometry/uncertain_pose.hpp>
#include <samewhere/scene/map_version.hpp>
#include <samewhere/verify/odometry_tree.hpp>

namespace samewhere::verify {

// Odometry and loop edges of a map, with their covariances: what earlier loops have taken out of
// the drift. Not copyable: refers to its arguments, which outlive it. Not for maps with scale
// drift.
class DriftPaths {
 public:
  // `odometry` follows the map from here on.
  DriftPaths(const scene::MapVersion& map, OdometryTree& odometry)
      : map_(map), odometry_(odometry) {
    odometry_.follow(map);
  }
  DriftPaths(const DriftPaths&) = delete;
  DriftPaths& operator=(const DriftPaths&) = delete;

  // Covariance of the pose of `end` in `begin`, [m; rad], along the path with the least drift. An
  // upper bound of the marginal covariance of the pose graph, since other paths add information.
  // Nothing if no path joins the two.
  std::optional<core::Matrix6d> covariance(core::KeyframeId begin, core::KeyframeId end);

 private:
  // As seen from one of its ends.
  struct Edge {
    std::size_t to = 0;
    bool is_loop = false;
    std::size_t covariance = 0;  // its place in covariances_
    double cost = 0.0;           // additive along a path, m^2
  };
  // Two neighbours on a path, the later one first.
  struct Step {
    core::KeyframeId here;
    core::KeyframeId before;
    const Edge* edge = nullptr;
  };

  void collect_edges();
  void add_edge(core::KeyframeId a, core::KeyframeId b, bool is_loop,
                const core::Matrix6d& covariance);
  std::vector<Step> steps_between(core::KeyframeId begin, core::KeyframeId end) const;
  // The beginning of a part, a loop or odometry between loops, from its end. Of odometry in
  // `num_runs` parts the constant errors are the same.
  geometry::UncertainPose measured(const std::vector<Step>& part, double num_runs) const;

  const scene::MapVersion& map_;
  OdometryTree& odometry_;
  std::vector<std::vector<Edge>> edges_;  // of each keyframe; collected when first needed
  std::vector<core::Matrix6d> covariances_;
};

}  // namespace samewhere::verify
