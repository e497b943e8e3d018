#pragma once

#include <optional>
#include <vector>

#include <samewhere/core/ids.hpp>
#include <samewhere/core/rigid3.hpp>
#include <samewhere/geometry/uncertain_pose.hpp>
#include <samewhere/scene/map_version.hpp>
#include <samewhere/verify/systematic_drift.hpp>

namespace samewhere::verify {

// Odometry and loop edges of a map, with their covariances: what earlier loops have taken out of
// the drift. Not copyable: refers to the map, which outlives it. Not for maps with scale drift.
class DriftPaths {
 public:
  explicit DriftPaths(const scene::MapVersion& map) : map_(map) {}
  DriftPaths(const DriftPaths&) = delete;
  DriftPaths& operator=(const DriftPaths&) = delete;

  const scene::MapVersion& map() const { return map_; }

  // Covariance of the pose of `end` in `begin`, [m; rad], along the path with the least drift. An
  // upper bound of the marginal covariance of the pose graph, since other paths add information.
  // Nothing if no path joins the two. `bias`: of odometry from a file.
  std::optional<core::Matrix6d> covariance(core::KeyframeId begin, core::KeyframeId end,
                                           const SystematicDrift& bias);

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
                const core::Matrix6d& information);
  std::vector<Step> steps_between(core::KeyframeId begin, core::KeyframeId end) const;
  // The beginning of a part, a loop or odometry between loops, from its end. Of odometry in
  // `num_runs` parts the constant errors are the same.
  geometry::UncertainPose measured(const std::vector<Step>& part, const SystematicDrift& bias,
                                   double num_runs) const;

  const scene::MapVersion& map_;
  std::vector<std::vector<Edge>> edges_;  // of each keyframe; collected when first needed
  std::vector<core::Matrix6d> covariances_;
};

}  // namespace samewhere::verify
