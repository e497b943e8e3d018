#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/random.hpp>
#include <samewhere/library/test_walk.hpp>
#include <samewhere/loop_closer.hpp>
#include <samewhere/loop_verifier.hpp>
#include <samewhere/pipeline/slam.hpp>

namespace samewhere::library {
namespace {

using testing::HasSubstr;

// Odometry of the walk with small errors, and their covariance.
std::vector<OdometryFrame> odometry_frames() {
  const TestWalk& walk = test_walk();
  core::Random random(7);
  Covariance covariance = 1e-6 * Covariance::Identity();
  std::vector<OdometryFrame> frames;
  core::Rigid3 odom_from_body;
  const core::Rigid3& body_from_camera = walk.frames[0].rig->body_from_camera[0];
  for (std::size_t i = 0; i < walk.frames.size(); ++i) {
    if (i > 0) {
      core::Vector6d error;
      for (double& value : error) value = 1e-3 * random.gaussian();
      const core::Rigid3 step = body_from_camera * inverse(walk.truth[i - 1].world_from_camera) *
                                walk.truth[i].world_from_camera * inverse(body_from_camera);
      odom_from_body = odom_from_body * step * core::exp_r3so3(error);
    }
    OdometryFrame frame{walk.at(i), pose_of(odom_from_body), std::nullopt};
    if (i > 0) frame.covariance = covariance;
    frames.push_back(frame);
  }
  return frames;
}

// As `samewhere run --odometry` does: all rows are known before the first frame.
core::Ledger ledger_by_file(const std::vector<OdometryFrame>& frames,
                            pipeline::OdometrySensor sensor, core::Trajectory& trajectory) {
  pipeline::Config config = test_config(0);
  config.odometry.file = "odometry.tum";
  config.odometry.sensor = sensor;
  input::OdometryRows rows;
  for (const OdometryFrame& frame : frames)
    rows.push_back({frame.frame.stamp_s, rigid_of(frame.odom_from_body), frame.covariance});
  pipeline::Slam slam(config);
  slam.follow(std::make_shared<pipeline::OdometryPath>(config.odometry, rows));
  for (const core::Frame& frame : test_walk().frames) slam.feed(frame);
  slam.finish();
  trajectory = pipeline::trajectory_of(slam.map(), slam.frames());
  return slam.ledger();
}

std::map<std::uint64_t, std::string> last_verdicts(const std::vector<LoopVerdict>& verdicts) {
  std::map<std::uint64_t, std::string> last;
  for (const LoopVerdict& verdict : verdicts)
    last[verdict.candidate] = std::to_string(verdict.query.index) + " " +
                              std::to_string(verdict.match.index) + " " + verdict.check;
  return last;
}

LoopCloserOptions options_of(OdometrySensor sensor) {
  return {.sensor = sensor, .settings = test_settings(), .are_keyframes = false};
}

class LoopCloserTest
    : public testing::TestWithParam<std::pair<OdometrySensor, pipeline::OdometrySensor>> {};

TEST_P(LoopCloserTest, GivesTheVerdictsOfARunWithAnOdometryFile) {
  const auto frames = odometry_frames();
  core::Trajectory trajectory;
  std::vector<LoopVerdict> of_run;
  for (const core::LedgerRow& row : ledger_by_file(frames, GetParam().second, trajectory))
    of_run.push_back(verdict_of(row));
  LoopCloser closer(test_walk().calibration, options_of(GetParam().first));
  std::vector<LoopVerdict> verdicts;
  for (const OdometryFrame& frame : frames)
    for (const LoopVerdict& verdict : closer.add(frame)) verdicts.push_back(verdict);
  for (const LoopVerdict& verdict : closer.finish()) verdicts.push_back(verdict);
  ASSERT_FALSE(of_run.empty());
  EXPECT_EQ(last_verdicts(verdicts), last_verdicts(of_run));
  EXPECT_TRUE(std::any_of(verdicts.begin(), verdicts.end(), [](const LoopVerdict& verdict) {
    return verdict.decision == LoopDecision::kAccepted;
  }));
  const auto poses = closer.poses();
  ASSERT_EQ(poses.size(), trajectory.size());
  const Pose body_from_camera = test_walk().calibration.cameras[0].body_from_camera;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_LT(((poses[i].map_from_body * body_from_camera).translation() -
               trajectory[i].world_from_camera.translation)
                  .norm(),
              1e-3)
        << "frame " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(
    ByCovarianceAndByDriftModel, LoopCloserTest,
    testing::Values(std::pair(OdometrySensor::kCovariances, pipeline::OdometrySensor::kFile),
                    std::pair(OdometrySensor::kWheel, pipeline::OdometrySensor::kWheel),
                    std::pair(OdometrySensor::kVisual, pipeline::OdometrySensor::kVisual)));

TEST(LoopCloser, UsesEveryKeyframeThatIsGiven) {
  const auto frames = odometry_frames();
  LoopCloser closer(test_walk().calibration,
                    {.sensor = OdometrySensor::kVisual, .settings = test_settings()});
  std::size_t num_given = 0;
  for (std::size_t i = 0; i < frames.size(); i += 4, ++num_given) closer.add(frames[i]);
  closer.finish();
  EXPECT_EQ(closer.map()->num_keyframes(), num_given);
  EXPECT_EQ(closer.poses().size(), num_given);
}

TEST(LoopCloser, RefusesBadOdometryAndGoesOn) {
  const auto frames = odometry_frames();
  LoopCloser closer(test_walk().calibration, options_of(OdometrySensor::kCovariances));
  closer.add(frames[0]);
  const auto expect_refused = [&](const OdometryFrame& frame, const std::string& words) {
    try {
      closer.add(frame);
      ADD_FAILURE() << "was taken: " << words;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(words));
    }
  };
  OdometryFrame bad = frames[1];
  bad.odom_from_body.translation().x() = std::numeric_limits<double>::quiet_NaN();
  expect_refused(bad, "keyframe 1: odom_from_body is not finite or no rotation");
  bad = frames[1];
  bad.odom_from_body.linear() *= 2.0;
  expect_refused(bad, "no rotation");
  bad = frames[1];
  bad.covariance.reset();
  expect_refused(bad, "has no covariance");
  bad.covariance = -Covariance::Identity();
  expect_refused(bad, "positive definite");
  bad = frames[0];
  expect_refused(bad, "expected a later one than");
  EXPECT_NO_THROW(closer.add(frames[1]));
  closer.finish();
  EXPECT_THROW(closer.add(frames[2]), UsageError);
}

OdometryBetween true_odometry(std::size_t match, std::size_t query) {
  const TestWalk& walk = test_walk();
  const core::Rigid3& body_from_camera = walk.frames[0].rig->body_from_camera[0];
  return {
      .match_from_query = pose_of(body_from_camera * inverse(walk.truth[match].world_from_camera) *
                                  walk.truth[query].world_from_camera * inverse(body_from_camera)),
      .covariance = 1e-4 * Covariance::Identity()};
}

TEST(LoopVerifier, AcceptsOnePlaceThatOdometryExpects) {
  const LoopVerifier verifier(test_walk().calibration);
  const LoopVerdict verdict =
      verifier.verify(test_walk().at(0), test_walk().at(4), true_odometry(0, 4));
  EXPECT_EQ(verdict.decision, LoopDecision::kAccepted) << verdict.reason;
  ASSERT_TRUE(verdict.match_from_query);
  EXPECT_LT(
      (verdict.match_from_query->translation() - true_odometry(0, 4).match_from_query.translation())
          .norm(),
      0.05);
  EXPECT_TRUE(verdict.covariance);
}

TEST(LoopVerifier, RejectsALookAlikePlaceByOdometry) {
  const LoopVerifier verifier(test_walk().calibration);
  OdometryBetween odometry = true_odometry(0, 4);
  odometry.match_from_query.translation().x() += 5.0;  // another place, of the same look
  const LoopVerdict verdict = verifier.verify(test_walk().at(0), test_walk().at(4), odometry);
  EXPECT_EQ(verdict.decision, LoopDecision::kRejected);
  EXPECT_EQ(verdict.check, "odometry") << verdict.reason;
}

TEST(LoopVerifier, WithoutOdometryThePriorDecides) {
  const Frame match = test_walk().at(0);
  const Frame query = test_walk().at(4);
  const LoopVerifier repetitive(test_walk().calibration);
  EXPECT_EQ(repetitive.verify(match, query).decision, LoopDecision::kAmbiguous);
  const LoopVerifier unique(test_walk().calibration, {}, Prior::kUnique);
  EXPECT_EQ(unique.verify(match, query).decision, LoopDecision::kAccepted);
}

}  // namespace
}  // namespace samewhere::library
