// Acceptance on real recordings with the shipped config. ATE and rotational error are at most 20 %
// above the measured figures (bench/RESULTS.md); counts are exact or at most 20 % below.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opencv2/core/utility.hpp>
#include <unistd.h>

#include <samewhere/core/file.hpp>
#include <samewhere/input/test_folder.hpp>
#include <samewhere/run/open_source.hpp>
#include <samewhere/run/run.hpp>
#include <samewhere/run/run_metrics.hpp>

namespace samewhere {
namespace {

class Golden : public testing::Test {
 protected:
  void SetUp() override {
    cv::setNumThreads(1);
    const char* data = std::getenv("SAMEWHERE_DATA");
    if (data == nullptr) GTEST_SKIP() << "SAMEWHERE_DATA is not set";
    data_ = data;
  }

  pipeline::Config config_of(const std::string& name,
                             const std::vector<std::string>& assignments = {},
                             const std::string& profile = "default") const {
    pipeline::Config config = pipeline::load_config(profile, "", assignments);
    config.source = data_ + "/" + name;
    return config;
  }

  run::SlamEvaluation slam(const std::string& name) const {
    const pipeline::Config config = config_of(name);
    auto source = run::open_source(config);
    const core::Truth truth = source->truth();
    return run::evaluate_slam(
        run::findings_of(run::run_slam(std::move(source), config).record, false), truth);
  }

  // Recognition by HOG and exact search alone, without geometry.
  evaluate::PrecisionRecall hog(const std::string& name, int window_frames) const {
    const pipeline::Config config =
        config_of(name, {"verify.rank_by=similarity", "verify.require_geometry=false",
                         "verify.min_similarity=1",
                         "retrieve.window_frames=" + std::to_string(window_frames)});
    auto source = run::open_source(config);
    const core::Truth truth = source->truth();
    const run::RunOutcome outcome = run::run_recognition(std::move(source), config);
    return *run::evaluate_recognition({0, outcome.matches, outcome.accepted, window_frames}, truth)
                .curve;
  }

  std::string data_;
};

// From `first_of_next` on no confirmed pose may refer to the map of the floor before.
void expect_no_pose_on_the_floor_before(const pipeline::Config& config,
                                        std::uint64_t first_of_next) {
  const report::RunRecord record = run::run_slam(run::open_source(config), config).record;
  ASSERT_GT(record.frames.size(), first_of_next);
  std::map<core::KeyframeId, std::uint64_t> frame_of_keyframe;
  for (const report::FrameRecord& frame : record.frames) {
    const core::FramePose& pose = frame.pose;
    if (!is_confirmed(pose)) continue;
    // the first frame that refers to a keyframe is that keyframe, or was tracked near it
    const auto [reference, is_first] =
        frame_of_keyframe.try_emplace(pose.reference_keyframe, pose.frame.index());
    if (pose.frame.index() < first_of_next) continue;
    EXPECT_GT(reference->second, first_of_next - 30) << "frame " << pose.frame.index();
  }
}

// Picture 163 is missed. The landing of floor 3 (picture 13) looks like that of floor 2 (164).
TEST_F(Golden, TheWrongFloorOfAStaircaseIsNeverConfirmed) {
  expect_no_pose_on_the_floor_before(config_of("staircase"), 163);
}

// The last flight before the landing is missed, 1.6 s at the true rate: the landing of the floor
// before is inside the gate of the motion.
TEST_F(Golden, NorAfterAFlightThatIsMissed) {
  constexpr int kFirstMissed = 152;
  constexpr int kLastMissed = 163;
  const input::TestFolder folder;
  for (const auto& entry : std::filesystem::directory_iterator(data_ + "/staircase")) {
    const std::string name = entry.path().filename().string();
    const bool is_picture = entry.path().extension() == ".jpg";
    const int number = is_picture ? std::stoi(name) : 0;
    if (number < kFirstMissed || number > kLastMissed)
      std::filesystem::create_symlink(entry.path(), folder.root() / name);
  }
  pipeline::Config config = config_of("staircase", {"input.fps=8"});
  config.source = folder.root().string();
  expect_no_pose_on_the_floor_before(config, kFirstMissed);
}

// Revisits are tracked in the same map, so no loop closure is needed.
TEST_F(Golden, RedkitchenIsTrackedToTheEndInOneMap) {
  const auto run = slam("redkitchen");
  EXPECT_EQ(run.num_measured, 1000);
  EXPECT_LT(run.ate->rmse_m, 0.06);
  EXPECT_EQ(run.loops.num_false, 0);
}

TEST_F(Golden, HololensClosesItsLoop) {
  const auto run = slam("hololens");
  EXPECT_EQ(run.num_measured, 373);
  EXPECT_LT(run.ate->rmse_m, 0.059);
  EXPECT_EQ(run.loops.num_true, 1);
  EXPECT_EQ(run.loops.num_false, 0);
}

TEST_F(Golden, NearPureRotationIsTrackedToTheEnd) {
  const auto run = slam("tum_fr1_rpy");
  EXPECT_EQ(run.num_measured, 200);
  EXPECT_LT(run.ate->rmse_m, 0.032);
  EXPECT_LT(run.rpe->rotation_median_deg, 2.64);
  EXPECT_EQ(run.loops.num_false, 0);
}

// Two laps through a corridor of near-identical doors, 44 true loops; the best peer closes 43.
TEST_F(Golden, ImagesAloneCloseTheLoopsOfTheSecondLapThroughTheCorridor) {
  const pipeline::Config config = config_of(
      "rtabmap_corridor", {"retrieve.window_frames=19", "verify.prior=unique"}, "recognition");
  auto source = run::open_source(config);
  const core::Truth truth = source->truth();
  const run::RunOutcome outcome = run::run_recognition(std::move(source), config);
  const auto found =
      *run::evaluate_recognition({0, outcome.matches, outcome.accepted, 19}, truth).accepted;
  EXPECT_GE(found.num_true, 42);
  EXPECT_EQ(found.num_false, 0);
}

// One corridor on two real floors, every loop is false; every fifth image.
TEST_F(Golden, AppearanceAloneAcceptsNothingOnTwoFloorsThatLookAlike) {
  const auto list = std::filesystem::path(testing::TempDir()) /
                    fmt::format("samewhere_two_floors_{}.txt", getpid());
  std::string images;
  for (int floor : {2, 3})
    for (int i = 1; i < 500; i += 10)
      images += fmt::format("{}/twofloors/f{}_{:05}.jpg\n", data_, floor, i);
  core::write_file(list, images);
  pipeline::Config config = pipeline::load_config("recognition", "", {"retrieve.window_frames=45"});
  config.source = list.string();
  const run::RunOutcome outcome = run::run_recognition(run::open_source(config), config);
  std::filesystem::remove(list);
  EXPECT_TRUE(outcome.accepted.empty());
  const auto is_alone = [](const core::LedgerRow& row) {
    return core::stage_of(row.verdict) == "evidence";
  };
  EXPECT_GT(std::ranges::count_if(outcome.record.ledger, is_alone), 20)
      << "without look-alikes that pass all other checks this shows nothing";
}

// Bounds: the better published HOG row of docs/evaluation.md.
TEST_F(Golden, HogIsNotBelowPublishedHog) {
  const auto corridor = hog("rtabmap_corridor", 19);
  EXPECT_GE(corridor.auc, 0.510);
  EXPECT_GE(corridor.recall_at_full_precision, 0.205);
  const auto kitchen = hog("redkitchen", 149);
  EXPECT_GE(kitchen.auc, 0.687);
  EXPECT_GE(kitchen.recall_at_full_precision, 0.347);
  const auto hololens = hog("hololens", 60);
  EXPECT_GE(hololens.auc, 0.221);
  EXPECT_GE(hololens.recall_at_full_precision, 0.111);
}

}  // namespace
}  // namespace samewhere
