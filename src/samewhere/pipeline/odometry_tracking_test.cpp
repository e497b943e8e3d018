#include <functional>

#include <Eigen/LU>
#include <gtest/gtest.h>
#include <opencv2/core/utility.hpp>

#include <samewhere/evaluate/degraded_odometry.hpp>
#include <samewhere/pipeline/slam.hpp>
#include <samewhere/twin/front/twin.hpp>

namespace samewhere::pipeline {
namespace {

// A few seconds in the corridor, with a window so short that loops close, even between views that
// the map holds together anyway.
Config short_walk(const std::string& more = "") {
  Config config;
  config.source = "twin:office-loop?seed=5" + more;
  config.twin.num_frames = 24;
  config.retrieve.window_frames = 4;
  config.map.min_shared = 1000;
  config.odometry.file = "in memory";
  config.odometry.sensor = OdometrySensor::kWheel;
  config.odometry.keyframe_distance_m = 0.05;
  return config;
}

core::Trajectory true_poses(const Config& config) {
  return twin::open_twin(config.source, config.twin)->true_trajectory();
}

std::shared_ptr<const OdometryPath> path_of(const core::Trajectory& odometry,
                                            const Config& config) {
  input::OdometryRows rows;
  for (const auto& pose : odometry) rows.push_back({pose.stamp_s, pose.world_from_camera, {}});
  return std::make_shared<const OdometryPath>(config.odometry, std::move(rows));
}

using IsDark = std::function<bool(std::uint64_t index)>;

void walk(Slam& slam, const Config& config, const core::Trajectory& odometry,
          const IsDark& is_dark = {}) {
  cv::setNumThreads(1);
  slam.follow(path_of(odometry, config));
  const auto source = twin::open_twin(config.source, config.twin);
  while (auto frame = source->next()) {
    if (is_dark && is_dark(frame->id.index())) {
      frame->images[0] = cv::Mat::zeros(frame->images[0].size(), frame->images[0].type());
      frame->depth_m.reset();
    }
    slam.feed(*frame);
  }
  slam.finish();
}

double farthest_m(const core::Trajectory& trajectory, const core::Trajectory& odometry) {
  double farthest = 0.0;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const core::Rigid3 first_from_this =
        inverse(odometry[0].world_from_camera) * odometry[i].world_from_camera;
    farthest = std::max(
        farthest,
        (first_from_this.translation - trajectory[i].world_from_camera.translation).norm());
  }
  return farthest;
}

TEST(OdometryTracking, PosesAreThoseOfTheFileHoweverWrong) {
  Config config = short_walk();
  config.close_loops = false;
  const core::Trajectory poor =
      evaluate::degraded(true_poses(config), evaluate::degradation_of("10%+slip"), 3);
  Slam slam(config);
  walk(slam, config, poor);
  const core::Trajectory trajectory = trajectory_of(slam.map(), slam.frames());
  ASSERT_EQ(trajectory.size(), 24U);
  EXPECT_LT(farthest_m(trajectory, poor), 1e-6);
  EXPECT_GT(num_live(slam.map().landmarks), 100U) << "landmarks come from depth";
  EXPECT_GT(slam.frames().back().num_inliers, 50) << "and are seen again";
}

TEST(OdometryTracking, CountsTheFramesAtWhichImagesContradictTheFile) {
  Config config = short_walk();
  config.close_loops = false;
  core::Trajectory odometry = true_poses(config);
  Slam right(config);
  walk(right, config, odometry);
  EXPECT_GT(right.odometry_agreement().num_compared, 15);
  EXPECT_EQ(right.odometry_agreement().num_contradicted, 0);
  for (std::size_t i = 0; i < odometry.size(); ++i) {
    core::Rigid3& pose = odometry[i].world_from_camera;
    pose.rotation = (pose.rotation * core::exp_so3({0.0, 0.03 * i, 0.0})).normalized();
  }
  Slam turned(config);
  walk(turned, config, odometry);
  EXPECT_GT(turned.odometry_agreement().num_contradicted,
            turned.odometry_agreement().num_compared / 2);
}

TEST(OdometryTracking, InThreadsAndInTurnTheSameBits) {
  Config in_turn = short_walk();
  in_turn.threads = false;
  const core::Trajectory poor =
      evaluate::degraded(true_poses(in_turn), evaluate::degradation_of("1deg/m"), 1);
  Slam first(short_walk());
  Slam second(in_turn);
  walk(first, short_walk(), poor);
  walk(second, in_turn, poor);
  const core::Trajectory a = trajectory_of(first.map(), first.frames());
  const core::Trajectory b = trajectory_of(second.map(), second.frames());
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    EXPECT_EQ(a[i].world_from_camera.matrix(), b[i].world_from_camera.matrix()) << "frame " << i;
  EXPECT_EQ(first.ledger().size(), second.ledger().size());
  EXPECT_FALSE(first.map().loops.empty()) << "without a loop this shows little";
}

// A walk with rows missing for frames 10 to 14.
Config walk_with_gap(core::Trajectory& odometry) {
  Config config = short_walk();
  config.close_loops = false;
  config.odometry.max_gap_s = 0.1;
  odometry = true_poses(config);
  odometry.erase(odometry.begin() + 10, odometry.begin() + 15);
  return config;
}

TEST(OdometryTracking, InAGapImagesGiveThePoses) {
  core::Trajectory odometry;
  const Config config = walk_with_gap(odometry);
  Slam slam(config);
  walk(slam, config, odometry);
  const core::Trajectory trajectory = trajectory_of(slam.map(), slam.frames());
  ASSERT_EQ(trajectory.size(), 24U);
  EXPECT_LT(farthest_m(trajectory, true_poses(config)), 0.02);
  for (std::size_t k = 1; k < slam.map().keyframes.size(); ++k) {
    const core::Matrix6d covariance = slam.map().keyframes[k].odometry->information.inverse();
    EXPECT_LT(std::sqrt(covariance(0, 0)), 0.05) << "keyframe " << k;
  }
}

TEST(OdometryTracking, ADarkGapLeavesFramesWithoutAPoseAndAnUncertainEdge) {
  core::Trajectory odometry;
  const Config config = walk_with_gap(odometry);
  Slam slam(config);
  walk(slam, config, odometry, [](std::uint64_t index) { return index >= 10 && index <= 15; });
  for (std::size_t i = 0; i < slam.frames().size(); ++i)
    EXPECT_EQ(slam.frames()[i].is_measured, i < 10 || i >= 15) << "frame " << i;
  EXPECT_EQ(slam.phase(), SessionPhase::kTracking) << "no relocalization is needed";
  const double gap_s = 6.0 / 15.0;
  double largest = 0.0;
  for (std::size_t k = 1; k < slam.map().keyframes.size(); ++k)
    largest =
        std::max(largest, slam.map().keyframes[k].odometry->information.inverse().eval()(0, 0));
  EXPECT_GT(std::sqrt(largest), config.odometry.gap_per_s * gap_s);
}

// A recording that is paused in a lift: the landing of the other floor looks the same.
TEST(OdometryTracking, ImagesDoNotBridgeWhatNeitherTheyNorOdometryHaveSeen) {
  Config config = short_walk();
  config.close_loops = false;
  constexpr double kPause_s = 20.0;
  core::Trajectory odometry = true_poses(config);
  for (std::size_t i = 12; i < odometry.size(); ++i) odometry[i].stamp_s += kPause_s;
  Slam slam(config);
  slam.follow(path_of(odometry, config));
  const auto source = twin::open_twin(config.source, config.twin);
  while (auto frame = source->next()) {
    if (frame->id.index() >= 12) frame->stamp_s += kPause_s;
    slam.feed(*frame);
  }
  slam.finish();
  double largest = 0.0;
  for (std::size_t k = 1; k < slam.map().keyframes.size(); ++k)
    largest =
        std::max(largest, slam.map().keyframes[k].odometry->information.inverse().eval()(0, 0));
  EXPECT_GT(std::sqrt(largest), 0.9 * config.odometry.gap_per_s * kPause_s);
}

// As the floor indicator of a lift: with planar odometry only images tell the height.
TEST(OdometryTracking, OfOdometryInAPlaneAnUnseenHeightIsUnknown) {
  Config config = short_walk();
  config.close_loops = false;
  core::Trajectory odometry = true_poses(config);
  for (auto& pose : odometry) pose.world_from_camera.translation.z() = 1.5;
  // later it turns a corner: a line alone has no plane
  odometry.push_back(odometry.back());
  odometry.back().stamp_s += 10.0;
  odometry.back().world_from_camera.translation += Eigen::Vector3d(2.0, 2.0, 0.0);
  const auto height_sigma_m = [&](const IsDark& is_dark) {
    Slam slam(config);
    walk(slam, config, odometry, is_dark);
    double largest = 0.0;
    for (std::size_t k = 1; k < slam.map().keyframes.size(); ++k) {
      const scene::Keyframe& keyframe = slam.map().keyframes[k];
      const Eigen::Vector3d up =
          inverse(odometry[slam.map().keyframes[k - 1].view.frame.index()].world_from_camera)
              .rotation *
          Eigen::Vector3d::UnitZ();
      const core::Matrix6d covariance = keyframe.odometry->information.inverse();
      largest = std::max(largest, up.dot(covariance.topLeftCorner<3, 3>() * up));
    }
    return std::sqrt(largest);
  };
  EXPECT_LT(height_sigma_m({}), 0.06);
  EXPECT_GT(height_sigma_m([](std::uint64_t index) { return index >= 10; }), 0.12);
}

TEST(OdometryTracking, OneCameraTriangulatesInMetres) {
  Config config = short_walk("&camera=mono");
  config.close_loops = false;
  const core::Trajectory truth = true_poses(config);
  Slam slam(config, DepthFrom::kMotion);
  walk(slam, config, truth);
  EXPECT_LT(farthest_m(trajectory_of(slam.map(), slam.frames()), truth), 1e-6);
  EXPECT_FALSE(has_scale_drift(slam.map()));
  EXPECT_GT(num_live(slam.map().landmarks), 50U);
}

TEST(OdometryTracking, OfAKnownMapItOnlyPredictsTheMotion) {
  Config config = short_walk();
  config.odometry.file.clear();
  config.close_loops = false;
  const core::Trajectory truth = true_poses(config);
  Slam first(config);
  const auto source = twin::open_twin(config.source, config.twin);
  while (const auto frame = source->next()) first.feed(*frame);
  first.finish();
  scene::StoredMap known{first.map(), {first.frames(), first.descriptors(), {}, {}}};
  config.odometry.file = "in memory";
  Slam slam(config, known, Slam::Use::kLocalize);
  slam.follow(path_of(truth, config));
  const auto again = twin::open_twin(config.source, config.twin);
  while (auto frame = again->next()) {
    frame->id = core::FrameId(frame->id.index(), slam.session());
    slam.feed(*frame);
  }
  slam.finish();
  EXPECT_NE(slam.phase(), SessionPhase::kInitializing);
  EXPECT_EQ(slam.map().keyframes.size(), first.map().keyframes.size());
}

}  // namespace
}  // namespace samewhere::pipeline
