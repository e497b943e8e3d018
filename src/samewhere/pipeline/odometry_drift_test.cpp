#include <cmath>
#include <cstdint>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <samewhere/evaluate/degraded_odometry.hpp>
#include <samewhere/pipeline/map_context.hpp>
#include <samewhere/pipeline/odometry_path.hpp>
#include <samewhere/verify/expected_end.hpp>

namespace samewhere::pipeline {
namespace {

constexpr double kRate_hz = 15.0;

// Camera axes of a body that looks ahead, heading about the vertical z of the world.
core::Rigid3 upright(const Eigen::Vector3d& position, double heading_rad) {
  Eigen::Matrix3d axes;
  axes.col(0) = Eigen::Vector3d(0.0, -1.0, 0.0);  // right
  axes.col(1) = Eigen::Vector3d(0.0, 0.0, -1.0);  // down
  axes.col(2) = Eigen::Vector3d(1.0, 0.0, 0.0);   // ahead
  return {core::exp_so3({0.0, 0.0, heading_rad}) * Eigen::Quaterniond(axes), position};
}

// Twice around a block of 30 m by 15 m, at 1 m/s with turns of 2 s.
core::Trajectory two_laps() {
  core::Trajectory truth;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double heading_rad = 0.0;
  double stamp_s = 0.0;
  const auto add = [&] {
    truth.push_back({stamp_s, upright(position, heading_rad)});
    stamp_s += 1.0 / kRate_hz;
  };
  for (int side = 0; side < 8; ++side) {
    const int num_steps = static_cast<int>((side % 2 == 0 ? 30.0 : 15.0) * kRate_hz);
    for (int i = 0; i < num_steps; ++i, add())
      position += Eigen::Vector3d(std::cos(heading_rad), std::sin(heading_rad), 0.0) / kRate_hz;
    for (int i = 0; i < 30; ++i, add()) heading_rad += 0.5 * M_PI / 30.0;
  }
  return truth;
}

input::OdometryRows rows_of(const core::Trajectory& poses) {
  input::OdometryRows rows;
  for (const auto& pose : poses) rows.push_back({pose.stamp_s, pose.world_from_camera, {}});
  return rows;
}

// A keyframe each third of a metre or so.
scene::MapVersion chain_of(const core::Trajectory& odometry, const OdometryPath& path) {
  constexpr std::size_t kFrames = 5;
  scene::MapVersion map;
  for (std::size_t i = 0; i < odometry.size(); i += kFrames) {
    scene::Keyframe keyframe;
    keyframe.id = core::KeyframeId(map.keyframes.size());
    keyframe.world_from_body = odometry[i].world_from_camera;
    keyframe.view.stamp_s = odometry[i].stamp_s;
    if (i > 0) {
      const auto& parent = map.keyframes.back();
      const auto motion = path.motion(parent.view.stamp_s, keyframe.view.stamp_s);
      keyframe.odometry = {parent.id, motion.a_from_b, motion.covariance.inverse()};
    }
    map.keyframes.push_back(keyframe);
  }
  return map;
}

struct Condition {
  const char* kinds;
  OdometrySensor sensor;
  double drift_rad_per_metre = 0.0;  // as a setting
};

void PrintTo(const Condition& condition, std::ostream* out) { *out << condition.kinds; }

OdometryConfig config_of(const Condition& condition) {
  OdometryConfig config;
  config.file = "odometry.tum";
  config.sensor = condition.sensor;
  config.drift_rad_per_metre = condition.drift_rad_per_metre;
  return config;
}

// Mean NEES over the seeds of the pose so many keyframes after the first.
double mean_nees(const Condition& condition, std::size_t num_edges) {
  constexpr std::uint64_t kSeeds = 20;
  const core::Trajectory truth = two_laps();
  const OdometryConfig config = config_of(condition);
  double sum = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const core::Trajectory odometry =
        evaluate::degraded(truth, evaluate::degradation_of(condition.kinds), seed);
    const OdometryPath path(config, rows_of(odometry));
    const scene::MapVersion map = chain_of(odometry, path);
    verify::OdometryTree tree(systematic_drift(config));
    tree.follow(map);
    const auto by_odometry = tree.between(core::KeyframeId(0), core::KeyframeId(num_edges));
    const core::Rigid3 known =
        inverse(truth[0].world_from_camera) * truth[5 * num_edges].world_from_camera;
    const core::Vector6d error = verify::difference(by_odometry->a_from_b, known);
    sum += error.dot(by_odometry->covariance.llt().solve(error));
  }
  return sum / kSeeds;
}

class DriftOfChains : public testing::TestWithParam<Condition> {};

// A few metres, a side, most of a lap, both laps: systematic drift grows with the distance, and the
// covariance with it. Ahead it is not much too large either; after a lap most errors cancel.
TEST_P(DriftOfChains, TheirCovarianceIsConsistentAtAnyLength) {
  for (const std::size_t num_edges : {10U, 80U, 200U, 294U, 460U}) {
    const double nees = mean_nees(GetParam(), num_edges);
    RecordProperty("nees_" + std::to_string(num_edges), std::to_string(nees));
    EXPECT_LT(nees, 6.0) << num_edges << " edges";
    if (num_edges <= 80) {
      EXPECT_GT(nees, 0.03) << num_edges << " edges";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, DriftOfChains,
                         testing::Values(Condition{"1%", OdometrySensor::kWheel},
                                         Condition{"2%", OdometrySensor::kWheel},
                                         Condition{"5%", OdometrySensor::kLeg},
                                         Condition{"10%", OdometrySensor::kPoor},
                                         Condition{"0.5deg/m", OdometrySensor::kLeg},
                                         Condition{"1deg/m", OdometrySensor::kPoor},
                                         Condition{"2deg/m", OdometrySensor::kPoor, 0.04},
                                         Condition{"slip", OdometrySensor::kPoor}));

TEST(SystematicDrift, GrowsWithTheDistanceAndNotWithItsRoot) {
  const core::Trajectory truth = two_laps();
  const OdometryPath path(config_of({"", OdometrySensor::kPoor}), rows_of(truth));
  const scene::MapVersion map = chain_of(truth, path);
  verify::OdometryTree tree({.per_metre = 0.1});
  tree.follow(map);
  const auto ahead_m = [&](unsigned end) {
    return std::sqrt(tree.systematic_covariance(core::KeyframeId(0), core::KeyframeId(end))(2, 2));
  };
  EXPECT_NEAR(ahead_m(20), 0.1 * 20.0 / 3.0, 1e-6);
  EXPECT_NEAR(ahead_m(80), 0.1 * 80.0 / 3.0, 1e-6);
  EXPECT_NEAR(ahead_m(294), 0.0, 0.2) << "after a lap a wrong length cancels";
}

}  // namespace
}  // namespace samewhere::pipeline
