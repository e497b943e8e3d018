// `samewhere ledger` on a run folder, and on folders that are none.

#include <algorithm>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "program.hpp"
#include <samewhere/core/file.hpp>
#include <samewhere/input/test_folder.hpp>

namespace samewhere::test {
namespace {

using ::testing::HasSubstr;

constexpr const char* kLoops = R"({"version": 1, "candidates": [
{"query": 812, "match": 40, "verdict": "LOOP", "stage": "accepted", "reason": "60 features agree",
 "scores": {"similarity": 0.8, "num_matches": 120, "num_inliers": 60, "inlier_ratio": 0.5,
            "spread_ratio": 0.4, "reprojection_rmse_px": 1.1},
 "match_from_query": [0.1, 0, 0, 0, 0, 0, 1]},
{"query": 813, "match": 41, "verdict": "NOT", "stage": "odometry", "reason": "would move the camera",
 "scores": {"similarity": 0.7, "num_matches": 150, "num_inliers": 90, "inlier_ratio": 0.6,
            "spread_ratio": 0.4, "reprojection_rmse_px": 1.0, "correction_m": 9.8,
            "correction_rad": 0.1, "mahalanobis_squared": 400.0},
 "match_from_query": [9.8, 0, 0, 0, 0, 0, 1]}]})";

class LedgerCommand : public testing::Test {
 protected:
  LedgerCommand() {
    folder_.write("loops.json", kLoops);
    folder_.write("config.yaml", "seed: 3\n");
  }
  Outcome run(const std::string& arguments) const {
    return run_program("ledger " + quoted(folder_.root()) + " " + arguments, folder_.root());
  }
  input::TestFolder folder_;
};

TEST_F(LedgerCommand, ListsRejectedCandidatesWithReasons) {
  const Outcome all = run("list");
  EXPECT_EQ(all.exit_code, 0) << all.err;
  EXPECT_THAT(all.out, HasSubstr("812"));
  const Outcome refused = run("list --stage odometry");
  EXPECT_THAT(refused.out, HasSubstr("would move the camera"));
  EXPECT_EQ(refused.out.find("812"), std::string::npos);
}

TEST_F(LedgerCommand, ShowsAllMeasurementsOfACandidate) {
  const Outcome shown = run("show 1");
  EXPECT_EQ(shown.exit_code, 0) << shown.err;
  EXPECT_THAT(shown.out, HasSubstr("9.8 m"));
  EXPECT_THAT(shown.out, HasSubstr("(at most 16.81)")) << "the bar of the run's config";
  EXPECT_THAT(run("show 0").out, HasSubstr("unmeasured")) << "odometry never spoke";
  const Outcome none = run("show 2");
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.err, HasSubstr("no candidate 2; expected 0 to 1"));
}

TEST_F(LedgerCommand, ReplaysWithOtherThresholds) {
  const Outcome strict = run("replay --set verify.min_inliers=80");
  EXPECT_EQ(strict.exit_code, 0) << strict.err;
  EXPECT_THAT(strict.out, HasSubstr("\nChanged:"));
  EXPECT_THAT(strict.out, HasSubstr("only 60 inliers of one geometry, 80 needed"));
  const std::string lax = "replay --set verify.max_odometry_chi_square=500";
  EXPECT_THAT(run(lax).out, HasSubstr("appearance alone: cannot be told from a look-alike place"));
  EXPECT_THAT(run(lax + " --set verify.prior=unique").out, HasSubstr("90 inliers of one geometry"));
  EXPECT_EQ(run("replay --set verify.nonsense=1").exit_code, 2);
  EXPECT_EQ(run("replay --set seed=1").exit_code, 2) << "which a replay could not follow";
  EXPECT_EQ(run("replay").exit_code, 2);
}

TEST_F(LedgerCommand, APictureNeedsAMap) {
  const Outcome shown = run("show 1 --picture why.svg");
  EXPECT_EQ(shown.exit_code, 2);
  EXPECT_THAT(shown.err, HasSubstr("map.sw: no such file"));
  EXPECT_EQ(std::count(shown.err.begin(), shown.err.end(), '\n'), 1);
  EXPECT_FALSE(std::filesystem::exists(folder_.root() / "why.svg"));
}

TEST_F(LedgerCommand, OverridingADecisionNeedsAMap) {
  for (const char* word : {"reject 0", "force 1"}) {
    const Outcome without_map = run(word);
    EXPECT_EQ(without_map.exit_code, 2);
    EXPECT_EQ(std::count(without_map.err.begin(), without_map.err.end(), '\n'), 1);
  }
  EXPECT_THAT(run("reject 2").err, HasSubstr("no candidate 2; expected 0 to 1"));
  EXPECT_THAT(run("reject 0 --set features.num_levels=4").err,
              HasSubstr("optimize, map or verify"));
}

TEST(LedgerOfARun, WithdrawsALoopAndClosesItAgain) {
  input::TestFolder folder;
  const std::string out = quoted(folder.root() / "run");
  // with so short a window, and no covisible keyframes excluded, neighbours close loops
  const Outcome walked = run_program(
      "run 'twin:office-loop?seed=2' --set twin.num_frames=11 --set retrieve.window_frames=4 "
      "--set map.min_shared=1000 --set map.min_tracked_ratio=0.95 --out " +
          out,
      folder.root());
  ASSERT_EQ(walked.exit_code, 0) << walked.err;
  const auto ledger = [&](const std::string& words) {
    return run_program("ledger " + out + " " + words, folder.root());
  };
  const auto num_loops = [&] {
    const std::string lines = ledger("list --verdict LOOP").out;
    return std::count(lines.begin(), lines.end(), '\n') - 1;
  };
  const auto num_before = num_loops();
  ASSERT_GE(num_before, 2);
  const Outcome rejected = ledger("reject 0");
  EXPECT_EQ(rejected.exit_code, 0) << rejected.err;
  EXPECT_THAT(rejected.out, HasSubstr(fmt::format("{} (before: {})", num_before - 1, num_before)));
  EXPECT_THAT(ledger("show 0").out, HasSubstr("withdrawn by hand"));
  EXPECT_EQ(num_loops(), num_before - 1);
  const Outcome forced = ledger("force 0");
  EXPECT_EQ(forced.exit_code, 0) << forced.err;
  EXPECT_THAT(ledger("show 0").out, HasSubstr("accepted by hand"));
  EXPECT_EQ(num_loops(), num_before);
}

TEST_F(LedgerCommand, AFolderThatNoRunWroteIsRefusedInOneLine) {
  folder_.write("loops.json", std::string(kLoops).substr(0, 300));
  const Outcome cut = run("list");
  EXPECT_EQ(cut.exit_code, 2);
  EXPECT_THAT(cut.err, HasSubstr("loops.json"));
  EXPECT_EQ(std::count(cut.err.begin(), cut.err.end(), '\n'), 1);
}

}  // namespace
}  // namespace samewhere::test
