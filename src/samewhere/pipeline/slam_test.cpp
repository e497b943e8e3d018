#include <gtest/gtest.h>
#include <opencv2/core/utility.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/pipeline/open_source.hpp>
#include <samewhere/pipeline/slam.hpp>

namespace samewhere::pipeline {
namespace {

// A few seconds in the corridor, with a window so short that loops close.
Config short_walk() {
  Config config;
  config.source = "twin:office-loop?seed=5";
  config.twin.num_frames = 24;
  config.retrieve.window_frames = 4;
  return config;
}

void walk(Slam& slam, const Config& config) {
  cv::setNumThreads(1);
  const auto source = open_source(config);
  while (const auto frame = source->next()) slam.feed(*frame);
}

TEST(Slam, AFrameThatBecameAKeyframeStaysWhereItsKeyframeIsMoved) {
  Slam slam(short_walk());
  walk(slam, short_walk());
  ASSERT_FALSE(slam.map().loops.empty()) << "without a correction this shows nothing";
  int num_compared = 0;
  const core::Trajectory trajectory = trajectory_of(slam.map(), slam.frames());
  ASSERT_EQ(trajectory.size(), slam.frames().size()) << "every frame is measured here";
  for (std::size_t k = 0; k < slam.map().keyframes.size(); ++k) {
    const scene::Keyframe& keyframe = slam.map().keyframes[k];
    const core::Rigid3& placed = trajectory[keyframe.view.frame.index()].world_from_camera;
    EXPECT_LT(core::log_r3so3(inverse(keyframe.world_from_body) * placed).norm(), 1e-9)
        << "keyframe " << k;
    ++num_compared;
  }
  EXPECT_GT(num_compared, 5);
}

TEST(Slam, TwiceTheSameWalkGivesTheSameBits) {
  Slam first(short_walk());
  Slam second(short_walk());
  walk(first, short_walk());
  walk(second, short_walk());
  ASSERT_FALSE(first.map().loops.empty());
  const core::Trajectory a = trajectory_of(first.map(), first.frames());
  const core::Trajectory b = trajectory_of(second.map(), second.frames());
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].world_from_camera.matrix(), b[i].world_from_camera.matrix()) << "frame " << i;
  }
  EXPECT_EQ(first.ledger().size(), second.ledger().size());
}

TEST(Slam, BlackFramesAreLostAndTheWalkResumesAfterThem) {
  const Config config = short_walk();
  Slam slam(config);
  const auto source = open_source(config);
  while (auto frame = source->next()) {
    const auto index = frame->id.index();
    if (index == 10 || index == 11) frame->images[0] = cv::Mat::zeros(480, 640, CV_8UC3);
    slam.feed(*frame);
  }
  EXPECT_EQ(slam.frames()[10].status, core::FrameStatus::kLost);
  EXPECT_FALSE(slam.frames()[11].is_measured) << "nothing is extrapolated";
  EXPECT_EQ(slam.frames()[12].status, core::FrameStatus::kResumed);
  EXPECT_EQ(slam.frames()[13].status, core::FrameStatus::kTracking);
  EXPECT_EQ(trajectory_of(slam.map(), slam.frames()).size(), slam.frames().size() - 2);
}

TEST(Profile, PaperIsThePublishedMethod) {
  const Config paper = profile("paper");
  EXPECT_EQ(paper.retrieve.search, retrieve::Search::kSampled);
  EXPECT_EQ(paper.retrieve.num_draws, 50);
  EXPECT_EQ(paper.verify.min_similarity, 0.7);
  EXPECT_EQ(paper.verify.pause_frames, 10);
  EXPECT_FALSE(paper.verify.require_geometry);
  EXPECT_THROW(profile("best"), core::InputError);
}

TEST(Config, SurvivesTheWayThroughYaml) {
  Config config = profile("paper");
  config.source = "a \"quoted\" folder: with #signs";
  config.verify.loop_sigma_m = 0.1234567890123;
  Config again;
  core::read_config(again, core::config_as_yaml(config, true), "memory");
  EXPECT_EQ(core::config_as_yaml(again), core::config_as_yaml(config));
}

}  // namespace
}  // namespace samewhere::pipeline
