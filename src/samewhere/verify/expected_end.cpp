#include <algorithm>
#include <cmath>
#include <vector>

#include <samewhere/verify/expected_end.hpp>

namespace samewhere::verify {
namespace {

using geometry::UncertainPose;

// Of a path, from its beginning on, in the frame of the beginning: each step as long as the crept
// scale makes it.
struct StretchedPath {
  std::vector<Eigen::Vector3d> steps;
  std::vector<bool> is_crept;  // on this step
  double stretch = 1.0;        // how many times as long it is
};

// Between the ends of a loop the map has one scale.
bool is_settled(const scene::MapVersion& map, core::KeyframeId from, core::KeyframeId to) {
  const auto older = std::min(from, to);
  const auto younger = std::max(from, to);
  return std::any_of(map.loops.begin(), map.loops.end(), [&](const scene::LoopEdge& loop) {
    return loop.match <= older && younger <= loop.query;
  });
}

// Of each step from the beginning on: whether the scale crept on it.
std::vector<bool> crept_steps(const scene::MapVersion& map,
                              const std::vector<core::KeyframeId>& path) {
  std::vector<bool> is_crept;
  for (std::size_t i = path.size() - 1; i > 0; --i)
    is_crept.push_back(!is_settled(map, path[i], path[i - 1]));
  return is_crept;
}

// `keyframes`: from the end back to the beginning.
StretchedPath stretched(const scene::MapVersion& map,
                        const std::vector<core::KeyframeId>& keyframes, double log_scale) {
  StretchedPath path{.steps = {}, .is_crept = crept_steps(map, keyframes)};
  const auto num_crept = std::count(path.is_crept.begin(), path.is_crept.end(), true);
  const double rate = num_crept > 0 ? log_scale / static_cast<double>(num_crept) : 0.0;
  const Eigen::Quaterniond begin_from_world =
      world_from_body(map, keyframes.back()).rotation.conjugate();
  double crept = 0.0;
  double before = 0.0;
  double after = 0.0;
  for (std::size_t i = keyframes.size() - 1; i > 0; --i) {
    const Eigen::Vector3d step =
        begin_from_world * (world_from_body(map, keyframes[i - 1]).translation -
                            world_from_body(map, keyframes[i]).translation);
    const double on_step = path.is_crept[path.steps.size()] ? rate : 0.0;
    path.steps.emplace_back(std::exp(crept + 0.5 * on_step) * step);
    crept += on_step;
    before += step.norm();
    after += path.steps.back().norm();
  }
  if (before > 0.0) path.stretch = after / before;
  return path;
}

// Of the end's position, if the scale crept by a share of 1 at each step at random, the sum of all
// known with the error of a loop's scale.
Eigen::Matrix3d covariance_of_creep(const StretchedPath& path, const ScaleErrors& scale) {
  Eigen::Vector3d rest = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> rests;  // what creep at a step stretches
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = path.steps.size(); i-- > 0;) {
    const Eigen::Vector3d& step = path.steps[i];
    if (path.is_crept[i]) {
      rests.emplace_back(rest + 0.5 * step);
      sum += rests.back();
    }
    rest += step;
  }
  if (rests.empty()) return Eigen::Matrix3d::Zero();
  const Eigen::Vector3d mean = sum / static_cast<double>(rests.size());
  Eigen::Matrix3d covariance = scale.loop * scale.loop * mean * mean.transpose();
  for (const Eigen::Vector3d& one : rests)
    covariance += scale.creep * scale.creep * (one - mean) * (one - mean).transpose();
  return covariance;
}

}  // namespace

std::optional<UncertainPose> expected_end(MapDrift& drift, core::KeyframeId begin,
                                          core::KeyframeId end, double log_scale,
                                          const ScaleErrors& scale) {
  const auto by_odometry = drift.odometry().between(begin, end);
  if (!by_odometry) return std::nullopt;
  const scene::MapVersion& map = drift.map();
  UncertainPose expected{inverse(world_from_body(map, begin)) * world_from_body(map, end),
                         by_odometry->covariance};
  if (!has_scale_drift(map)) return expected;
  const StretchedPath path = stretched(map, drift.odometry().path(begin, end), log_scale);
  expected.a_from_b.translation.setZero();
  for (const Eigen::Vector3d& step : path.steps) expected.a_from_b.translation += step;
  core::Vector6d lengths = core::Vector6d::Ones();
  lengths.head<3>().setConstant(path.stretch);
  expected.covariance = lengths.asDiagonal() * expected.covariance * lengths.asDiagonal();
  expected.covariance.topLeftCorner<3, 3>() += covariance_of_creep(path, scale);
  return expected;
}

core::Vector6d difference(const core::Rigid3& known, const core::Rigid3& claimed) {
  core::Vector6d difference;
  difference << claimed.translation - known.translation,
      core::log_so3(known.rotation.conjugate() * claimed.rotation);
  return difference;
}

}  // namespace samewhere::verify
