#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <samewhere/core/errors.hpp>
#include <samewhere/evaluate/trajectory_error.hpp>
#include <samewhere/geometry/alignment.hpp>

namespace samewhere::evaluate {
namespace {

constexpr double kMaxGap_s = 0.1;
constexpr double kSameStamp_s = 1e-3;
constexpr double kPairTolerance_ratio = 0.1;  // of delta_s

// Mean of the two middle values where the count is even. `values` is not empty.
double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

double root_mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

core::Trajectory::const_iterator first_not_before(const core::Trajectory& trajectory,
                                                  double stamp_s) {
  return std::lower_bound(
      trajectory.begin(), trajectory.end(), stamp_s,
      [](const core::StampedPose& pose, double stamp) { return pose.stamp_s < stamp; });
}

// The pose whose stamp is nearest, the earlier one of two; `trajectory` is not empty.
const core::StampedPose& nearest_pose(const core::Trajectory& trajectory, double stamp_s) {
  const auto after = first_not_before(trajectory, stamp_s);
  if (after == trajectory.begin()) return *after;
  const auto before = std::prev(after);
  if (after == trajectory.end()) return *before;
  return stamp_s - before->stamp_s <= after->stamp_s - stamp_s ? *before : *after;
}

}  // namespace

std::optional<core::Rigid3> truth_at(const core::Trajectory& truth, double stamp_s) {
  if (truth.size() < 2) return std::nullopt;
  const auto found = first_not_before(truth, stamp_s);
  const auto after = std::clamp(found, std::next(truth.begin()), std::prev(truth.end()));
  const auto before = std::prev(after);

  const double gap_s = after->stamp_s - before->stamp_s;
  const double since_s = stamp_s - before->stamp_s;
  const bool is_on_stamp =
      std::min(std::abs(since_s), std::abs(after->stamp_s - stamp_s)) < kSameStamp_s;
  const bool is_in_gap =
      stamp_s >= before->stamp_s && stamp_s <= after->stamp_s && gap_s <= kMaxGap_s;
  if (!is_on_stamp && !is_in_gap) return std::nullopt;

  const double ratio = std::clamp(since_s / gap_s, 0.0, 1.0);
  return core::interpolate(before->world_from_camera, after->world_from_camera, ratio);
}

std::optional<AteResult> ate(const core::Trajectory& truth, const core::Trajectory& estimate,
                             Alignment alignment) {
  std::vector<Eigen::Vector3d> true_positions;
  std::vector<Eigen::Vector3d> estimated_positions;
  for (const core::StampedPose& pose : estimate) {
    const std::optional<core::Rigid3> world_from_camera = truth_at(truth, pose.stamp_s);
    if (!world_from_camera) continue;
    true_positions.push_back(world_from_camera->translation);
    estimated_positions.push_back(pose.world_from_camera.translation);
  }
  if (true_positions.size() < 3) return std::nullopt;

  AteResult result;
  result.num_poses = static_cast<int>(true_positions.size());
  result.truth_from_estimate =
      geometry::align_points(estimated_positions, true_positions, alignment == Alignment::kSim3);
  result.scale = result.truth_from_estimate.scale;
  std::vector<double> errors_m;  // eq. (24)
  for (std::size_t i = 0; i < true_positions.size(); ++i) {
    const Eigen::Vector3d aligned = result.truth_from_estimate * estimated_positions[i];
    errors_m.push_back((true_positions[i] - aligned).norm());
  }
  const auto [least, largest] = std::minmax_element(errors_m.begin(), errors_m.end());
  result.min_m = *least;
  result.max_m = *largest;
  result.median_m = median(errors_m);
  result.rmse_m = root_mean_square(errors_m);  // eq. (25)
  return result;
}

double path_length_m(const core::Trajectory& trajectory, double first_s, double last_s) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    if (trajectory[i - 1].stamp_s < first_s || trajectory[i].stamp_s > last_s) continue;
    length_m += (trajectory[i].world_from_camera.translation -
                 trajectory[i - 1].world_from_camera.translation)
                    .norm();
  }
  return length_m;
}

std::optional<RpeResult> rpe(const core::Trajectory& truth, const core::Trajectory& estimate,
                             double delta_s, double scale) {
  core::require(delta_s > 0.0, "relative pose errors are over a positive time");
  std::vector<double> translations_m;
  std::vector<double> rotations_deg;
  for (const core::StampedPose& first : estimate) {
    const core::StampedPose& second = nearest_pose(estimate, first.stamp_s + delta_s);
    const double miss_s = std::abs(second.stamp_s - (first.stamp_s + delta_s));
    if (miss_s > kPairTolerance_ratio * delta_s) continue;
    const std::optional<core::Rigid3> true_first = truth_at(truth, first.stamp_s);
    const std::optional<core::Rigid3> true_second = truth_at(truth, second.stamp_s);
    if (!true_first || !true_second) continue;

    const core::Rigid3 true_motion = core::inverse(*true_first) * *true_second;
    core::Rigid3 motion = core::inverse(first.world_from_camera) * second.world_from_camera;
    motion.translation *= scale;
    const core::Rigid3 error = core::inverse(true_motion) * motion;
    translations_m.push_back(error.translation.norm());
    rotations_deg.push_back(core::angle_rad(error.rotation) * 180.0 / std::numbers::pi);
  }
  if (translations_m.empty()) return std::nullopt;
  return RpeResult{median(translations_m), root_mean_square(translations_m), median(rotations_deg),
                   root_mean_square(rotations_deg), static_cast<int>(translations_m.size())};
}

}  // namespace samewhere::evaluate
