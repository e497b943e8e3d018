#include <gtest/gtest.h>
#include <opencv2/core/utility.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/evaluate/trajectory_error.hpp>
#include <samewhere/input/rectify.hpp>
#include <samewhere/pipeline/profiles.hpp>
#include <samewhere/pipeline/slam.hpp>
#include <samewhere/twin/front/twin.hpp>

namespace samewhere::pipeline {
namespace {

// A few seconds in the corridor, with a window so short that loops close, even between views that
// the map holds together anyway.
Config short_walk() {
  Config config;
  config.source = "twin:office-loop?seed=5";
  config.twin.num_frames = 24;
  config.retrieve.window_frames = 4;
  config.map.min_shared = 1000;
  return config;
}

void walk(Slam& slam, const Config& config) {
  cv::setNumThreads(1);
  const auto source = twin::open_twin(config.source, config.twin);
  while (const auto frame = source->next()) slam.feed(*frame);
  slam.finish();
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
    if (!is_live(keyframe)) continue;
    const core::Rigid3& placed = trajectory[keyframe.view.frame.index()].world_from_camera;
    EXPECT_LT(core::log_r3so3(inverse(keyframe.world_from_body) * placed).norm(), 1e-9)
        << "keyframe " << k;
    ++num_compared;
  }
  EXPECT_GT(num_compared, 5);
}

// A program that is killed during a long stay has lost the poses of seconds, not of all the stay.
TEST(Slam, FramesOfALongStayAreSavedThoughNoKeyframeComes) {
  Config config = short_walk();
  config.threads = false;
  config.twin.num_frames = 1;
  std::size_t num_saved = 0;
  const KeepMap keep_map = [&](const scene::MapVersion&, const MapNews& news) {
    num_saved += news.frames.size();
  };
  Slam slam(config, DepthFrom::kSensor, keep_map);
  std::optional<core::Frame> frame = twin::open_twin(config.source, config.twin)->next();
  constexpr std::size_t kFramesFed = 70;
  for (std::size_t i = 0; i < kFramesFed; ++i) {
    frame->id = core::FrameId(i);
    frame->stamp_s = static_cast<double>(i) / 30.0;
    slam.feed(*frame);
  }
  EXPECT_GE(num_saved, 60U);
  EXPECT_LT(num_saved, kFramesFed);
  slam.finish();
  EXPECT_EQ(num_saved, kFramesFed);
  EXPECT_EQ(slam.map().keyframes.size(), 1U);
}

void expect_same_bits(const Slam& first, const Slam& second) {
  const core::Trajectory a = trajectory_of(first.map(), first.frames());
  const core::Trajectory b = trajectory_of(second.map(), second.frames());
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].world_from_camera.matrix(), b[i].world_from_camera.matrix()) << "frame " << i;
  }
  EXPECT_EQ(first.ledger().size(), second.ledger().size());
}

TEST(Slam, InThreadsAndInTurnTheSameWalkGivesTheSameBits) {
  Config in_turn = short_walk();
  in_turn.threads = false;
  Slam first(short_walk());
  Slam second(in_turn);
  walk(first, short_walk());
  walk(second, in_turn);
  ASSERT_FALSE(first.map().loops.empty());
  expect_same_bits(first, second);
}

TEST(Slam, FeaturesThatLeftMemoryAreTheSameWhenTheyComeBack) {
  Config forgetful = short_walk();
  forgetful.map.keyframes_in_memory = 1;
  Slam first(short_walk());
  Slam second(forgetful);
  walk(first, short_walk());
  walk(second, forgetful);
  ASSERT_FALSE(second.map().loops.empty()) << "old keyframes are looked at again";
  const auto& oldest = second.map().keyframes[0].view.features;
  EXPECT_NE(oldest->pages, nullptr);
  EXPECT_NE(oldest, first.map().keyframes[0].view.features);
  expect_same_bits(first, second);
}

TEST(Slam, WithLoopsOffThereIsOdometryAlone) {
  Config config = short_walk();
  config.close_loops = false;
  Slam slam(config);
  walk(slam, config);
  EXPECT_TRUE(slam.ledger().empty());
  EXPECT_TRUE(slam.map().loops.empty());
  EXPECT_EQ(trajectory_of(slam.map(), slam.frames()).size(), slam.frames().size());
}

TEST(Slam, BlackFramesAreLostAndTheWalkResumesAfterThem) {
  const Config config = short_walk();
  Slam slam(config);
  const auto source = twin::open_twin(config.source, config.twin);
  while (auto frame = source->next()) {
    const auto index = frame->id.index();
    if (index == 10 || index == 11) {
      frame->images[0] = cv::Mat::zeros(480, 640, CV_8UC3);
      frame->depth_m = cv::Mat::zeros(480, 640, CV_32F);
    }
    slam.feed(*frame);
  }
  slam.finish();
  EXPECT_EQ(slam.frames()[10].status, core::FrameStatus::kLost);
  EXPECT_FALSE(slam.frames()[11].is_measured) << "nothing is extrapolated";
  EXPECT_EQ(slam.frames()[12].status, core::FrameStatus::kResumed);
  EXPECT_EQ(slam.frames()[13].status, core::FrameStatus::kTracking);
  EXPECT_EQ(trajectory_of(slam.map(), slam.frames()).size(), slam.frames().size() - 2);
}

TEST(Slam, FramesBeforeTheMapSayWhatTheyWaitFor) {
  const Config config = short_walk();
  Slam slam(config);
  const auto source = twin::open_twin(config.source, config.twin);
  for (int i = 0; i < 3; ++i) {
    auto frame = source->next();
    if (i < 2) frame->depth_m = cv::Mat::zeros(480, 640, CV_32F);
    if (i == 0) frame->images[0] = cv::Mat::zeros(480, 640, CV_8UC3);
    slam.feed(*frame);
    if (i == 0) {
      EXPECT_EQ(slam.why_not_initialized(),
                "0 corners in the picture, expected 50: it is dark, blurred or of one tone");
    }
    if (i == 1) {
      EXPECT_TRUE(slam.why_not_initialized().ends_with(
          "has depth, expected 50: the depth pictures are missing or empty"));
    }
  }
  slam.finish();
  EXPECT_EQ(slam.frames()[0].status, core::FrameStatus::kWaitingForFeatures);
  EXPECT_EQ(slam.frames()[1].status, core::FrameStatus::kWaitingForDepth);
  EXPECT_EQ(slam.frames()[2].status, core::FrameStatus::kStarting);
}

TEST(Slam, OneCameraStartsLateAndThenFollowsTheTruthUpToScale) {
  Config config = short_walk();
  config.source = "twin:office-loop?seed=5&camera=mono";
  const auto source = twin::open_twin(config.source, config.twin);
  ASSERT_FALSE(source->info().has_depth);
  ASSERT_EQ(source->info().num_cameras, 1);
  Slam slam(config, DepthFrom::kMotion);
  cv::setNumThreads(1);
  while (const auto frame = source->next()) slam.feed(*frame);
  slam.finish();
  ASSERT_GE(slam.map().keyframes.size(), 2U);
  for (const auto& frame : slam.frames()) {
    if (frame.is_measured) break;
    EXPECT_EQ(frame.status, core::FrameStatus::kWaitingForParallax);
  }
  const core::Trajectory trajectory = trajectory_of(slam.map(), slam.frames());
  EXPECT_GT(trajectory.size(), slam.frames().size() / 2);
  const auto error =
      evaluate::ate(source->truth().trajectory, trajectory, evaluate::Alignment::kSim3);
  ASSERT_TRUE(error);
  EXPECT_LT(error->rmse_m, 0.03);
}

TEST(Slam, TwoCamerasStartFromOneFrameAndGiveTheSameBitsInThreadsAndInTurn) {
  cv::setNumThreads(1);
  Config config = short_walk();
  config.source = "twin:office-loop?seed=5&camera=stereo";
  const auto source = input::rectified(twin::open_twin(config.source, config.twin));
  ASSERT_EQ(source->info().num_cameras, 2);
  ASSERT_FALSE(source->info().has_depth);
  Slam in_threads(config);
  config.threads = false;
  Slam in_turn(config);
  while (const auto frame = source->next()) {
    in_threads.feed(*frame);
    in_turn.feed(*frame);
  }
  in_threads.finish();
  in_turn.finish();
  ASSERT_FALSE(in_turn.map().keyframes.empty());
  EXPECT_EQ(in_turn.map().keyframes[0].view.frame, core::FrameId(0));
  const core::Trajectory trajectory = trajectory_of(in_turn.map(), in_turn.frames());
  EXPECT_EQ(trajectory.size(), static_cast<std::size_t>(config.twin.num_frames));
  const auto error =
      evaluate::ate(source->truth().trajectory, trajectory, evaluate::Alignment::kSe3);
  ASSERT_TRUE(error);
  EXPECT_LT(error->rmse_m, 0.03);
  EXPECT_FALSE(in_turn.map().loops.empty());
  expect_same_bits(in_threads, in_turn);
}

// A config in which nothing is as published.
Config unpublished() {
  Config config;
  config.describe.width_px = config.describe.height_px = 100;
  config.describe.equalize = false;
  config.features.num_features = 77;
  config.retrieve = {.search = retrieve::Search::kExact,
                     .num_candidates = 7,
                     .place_frames = 9,
                     .num_draws = 11,
                     .min_similarity = 0.1,
                     .per_draw = retrieve::PerDraw::kNearest,
                     .group_size = 33,
                     .queue_size = 3};
  config.verify = {.min_similarity = 0.2,
                   .pause_frames = 4,
                   .require_geometry = true,
                   .rank_by = verify::RankBy::kInliers};
  return config;
}

void expect_published(const Config& config) {
  EXPECT_EQ(config.describe.width_px, 480);
  EXPECT_EQ(config.describe.height_px, 360);
  EXPECT_TRUE(config.describe.equalize);
  EXPECT_EQ(config.features.num_features, 1000);
  EXPECT_EQ(config.retrieve.search, retrieve::Search::kSampled);
  EXPECT_EQ(config.retrieve.num_candidates, 3);
  EXPECT_EQ(config.retrieve.place_frames, 0);
  EXPECT_EQ(config.retrieve.num_draws, 50);
  EXPECT_EQ(config.retrieve.min_similarity, 0.6);
  EXPECT_EQ(config.retrieve.per_draw, retrieve::PerDraw::kTop3);
  EXPECT_EQ(config.retrieve.group_size, 100);
  EXPECT_EQ(config.retrieve.queue_size, 10);
  EXPECT_EQ(config.verify.min_similarity, 0.7);
  EXPECT_EQ(config.verify.pause_frames, 10);
  EXPECT_FALSE(config.verify.require_geometry);
  EXPECT_EQ(config.verify.rank_by, verify::RankBy::kSimilarity);
}

TEST(Profile, PaperIsThePublishedMethodWhateverTheDefaultsBecome) {
  expect_published(profile("paper"));
  Config config = unpublished();
  core::read_config(config, kPaperProfile, "paper.yaml");
  expect_published(config);
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
