#include <numbers>
#include <vector>

#include <samewhere/evaluate/drift_at_return.hpp>
#include <samewhere/evaluate/trajectory_error.hpp>

namespace samewhere::evaluate {
namespace {

constexpr double kStep_m = 0.2;
constexpr double kMaxDistance_m = 1.0;
constexpr double kMaxTurn_rad = std::numbers::pi / 4.0;
constexpr double kMinPath_m = 5.0;

struct Waypoint {
  core::Rigid3 world_from_true;
  core::Rigid3 world_from_odometry;
  double stamp_s = 0.0;
  double path_m = 0.0;
};

// Where odometry and the truth have a pose, some steps apart.
std::vector<Waypoint> waypoints(const core::Trajectory& truth, const core::Trajectory& odometry) {
  std::vector<Waypoint> points;
  double path_m = 0.0;
  std::optional<core::Rigid3> last;
  for (const core::StampedPose& pose : odometry) {
    const auto known = truth_at(truth, pose.stamp_s);
    if (!known) continue;
    if (last) path_m += (known->translation - last->translation).norm();
    last = known;
    if (points.empty() || path_m - points.back().path_m >= kStep_m)
      points.push_back({*known, pose.world_from_camera, pose.stamp_s, path_m});
  }
  return points;
}

bool is_same_place(const core::Rigid3& a, const core::Rigid3& b) {
  return (a.translation - b.translation).norm() <= kMaxDistance_m &&
         core::angle_rad(a.rotation.conjugate() * b.rotation) <= kMaxTurn_rad;
}

}  // namespace

std::optional<DriftAtReturn> drift_at_first_return(const core::Trajectory& truth,
                                                   const core::Trajectory& odometry,
                                                   std::optional<double> not_before_s) {
  const std::vector<Waypoint> points = waypoints(truth, odometry);
  for (const Waypoint& query : points) {
    if (not_before_s && query.stamp_s < *not_before_s) continue;
    for (const Waypoint& match : points) {
      if (query.path_m - match.path_m < kMinPath_m) break;
      if (!is_same_place(match.world_from_true, query.world_from_true)) continue;
      const core::Rigid3 known = inverse(match.world_from_true) * query.world_from_true;
      const core::Rigid3 measured = inverse(match.world_from_odometry) * query.world_from_odometry;
      return DriftAtReturn{(measured.translation - known.translation).norm(),
                           query.path_m - match.path_m, query.stamp_s};
    }
  }
  return std::nullopt;
}

}  // namespace samewhere::evaluate
