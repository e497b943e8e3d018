#pragma once

#include <map>
#include <optional>
#include <vector>

#include <samewhere/core/ids.hpp>
#include <samewhere/core/rigid3.hpp>
#include <samewhere/geometry/uncertain_pose.hpp>
#include <samewhere/scene/map_version.hpp>
#include <samewhere/verify/systematic_drift.hpp>

namespace samewhere::verify {

// What odometry alone measured between any two keyframes. Keeps for each keyframe the sum of the
// errors from the first of its session on, so that a pose over thousands of edges costs no more
// than one over ten. Of the map that it follows.
class OdometryTree {
 public:
  // `bias`: of odometry from a file.
  explicit OdometryTree(const SystematicDrift& bias = {}) : bias_(bias) {}

  // Takes over the edges that are new or changed in this version.
  void follow(const scene::MapVersion& map);

  // The pose of `end` in `begin` through their youngest common ancestor, with the covariance of
  // random and of constant errors [m; rad], to first order and for the position to second order in
  // a constant heading error. Nothing between keyframes without a common ancestor (a new session):
  // odometry knows nothing of both.
  std::optional<geometry::UncertainPose> between(core::KeyframeId begin, core::KeyframeId end);
  // Its part by constant errors. ContractError without a common ancestor.
  core::Matrix6d systematic_covariance(core::KeyframeId begin, core::KeyframeId end);

  // From the end back to the beginning, both included. Empty without a common ancestor.
  std::vector<core::KeyframeId> path(core::KeyframeId begin, core::KeyframeId end) const;
  // The first of its session.
  core::KeyframeId origin(core::KeyframeId keyframe) const {
    return nodes_[keyframe.index()].origin;
  }
  std::optional<core::KeyframeId> parent(core::KeyframeId keyframe) const;
  // Of the edge to the odometry parent, which there is.
  const core::Matrix6d& edge_covariance(core::KeyframeId keyframe) const {
    return nodes_[keyframe.index()].edge_covariance;
  }

 private:
  struct Node {
    core::KeyframeId origin;
    std::size_t depth = 0;  // edges from the origin
    std::optional<scene::OdometryEdge> edge;
    core::Rigid3 origin_from_keyframe;
    core::Matrix6d edge_covariance = core::Matrix6d::Zero();
    // Of the twist about the origin by which random errors have moved the keyframe. The lever of
    // each is its distance from the origin, so that differences keep a precision of some
    // 1e-16 * (1 rad * distance)^2: 1e-8 m^2 at 10 km.
    core::Matrix6d twist_covariance = core::Matrix6d::Zero();
  };
  // Of the children of the edges from one keyframe up, the largest distance from it; as far as was
  // asked for.
  struct Reach {
    core::KeyframeId next;
    std::vector<double> after_edges_m = {0.0};
  };

  bool is_known(const scene::Keyframe& keyframe) const;
  void add(const scene::MapVersion& map, const scene::Keyframe& keyframe);
  std::optional<core::KeyframeId> common_ancestor(core::KeyframeId a, core::KeyframeId b) const;
  core::Matrix6d random_covariance(core::KeyframeId begin, core::KeyframeId end,
                                   core::KeyframeId ancestor) const;
  core::Matrix6d constant_covariance(core::KeyframeId begin, core::KeyframeId end,
                                     core::KeyframeId ancestor);
  // How far from the end the path goes, metres.
  double reach_m(core::KeyframeId begin, core::KeyframeId end, core::KeyframeId ancestor);
  const Node& at(core::KeyframeId keyframe) const { return nodes_[keyframe.index()]; }

  SystematicDrift bias_;
  std::vector<Node> nodes_;
  std::vector<ConstantErrors> constant_errors_;  // sums from the origin on; empty without bias
  std::map<core::KeyframeId, Reach> reaches_;
};

}  // namespace samewhere::verify
