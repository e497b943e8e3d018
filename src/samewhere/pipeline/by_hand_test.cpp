#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/input/test_folder.hpp>
#include <samewhere/pipeline/by_hand.hpp>
#include <samewhere/pipeline/run_folder.hpp>
#include <samewhere/pipeline/test_rooms.hpp>
#include <samewhere/report/frames.hpp>
#include <samewhere/report/loops.hpp>

namespace samewhere::pipeline {
namespace {

using scene::MapVersion;
using testing::HasSubstr;

// What the judge may have said of candidates for loops in the two rooms.
class ByHandInRooms : public LookAlikeRooms {
 protected:
  static core::LedgerRow row_of(const scene::LoopEdge& loop, std::size_t id) {
    core::LedgerRow row{{.id = core::CandidateId(id),
                         .query = core::FrameId(loop.query.index()),
                         .match = core::FrameId(loop.match.index()),
                         .similarity = 0.8},
                        {}};
    core::Rejection refused{row.candidate.id, {.similarity = 0.8}, core::Refusal::kInliers, "few"};
    refused.evidence.geometry.emplace();
    refused.evidence.geometry->match_from_query = core::Sim3::from_rigid(loop.match_from_query);
    row.verdict = refused;
    return row;
  }

  static core::LedgerRow accepted(core::LedgerRow row) {
    row.verdict = core::LoopClosure{.candidate = row.candidate.id,
                                    .evidence = core::evidence_of(row.verdict),
                                    .match_from_query = report::match_from_query_of(row.verdict)};
    return row;
  }

  std::string why_not_forced(const core::LedgerRow& row) const {
    try {
      forced_by_hand(map_, row, config_);
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "nothing was said";
  }
};

TEST_F(ByHandInRooms, AForcedLoopCorrectsTheMapAndSaysWhoSpoke) {
  map_ = with_next(with_next(map_));
  const ByHand changed = forced_by_hand(map_, row_of(true_loop(13, 1), 3), config_);
  ASSERT_EQ(changed.map.loops.size(), 1U);
  EXPECT_EQ(changed.map.loops[0].cause, core::CandidateId(3));
  EXPECT_LT(rmse_m(changed.map), rmse_m(map_));
  ASSERT_EQ(changed.rows.size(), 1U);
  EXPECT_TRUE(core::is_loop(changed.rows[0].verdict));
  EXPECT_THAT(core::reason_of(changed.rows[0].verdict), HasSubstr("by hand"));
}

TEST_F(ByHandInRooms, ARejectedLoopLeavesTheMapAsIfItHadNeverBeen) {
  const MapVersion believed = closed(map_, lie());
  ASSERT_GT(num_seen_in_both_rooms(believed), 100);
  const ByHand changed = rejected_by_hand(believed, accepted(row_of(lie(), kLie.index())), config_);
  EXPECT_TRUE(changed.map.loops.empty());
  EXPECT_EQ(survivors(changed.map), survivors(map_));
  ASSERT_EQ(changed.rows.size(), 1U);
  EXPECT_EQ(core::stage_of(changed.rows[0].verdict), "withdrawn");
  EXPECT_THAT(core::reason_of(changed.rows[0].verdict), HasSubstr("by hand"));
}

TEST_F(ByHandInRooms, WhatOdometryAndOtherLoopsContradictIsNotForced) {
  map_ = with_next(with_next(with_next(map_)));
  map_ = closed(closed(map_, true_loop(13, 1)), true_loop(14, 0));
  ASSERT_EQ(map_.loops.size(), 2U);
  EXPECT_THAT(why_not_forced(row_of(lie(), 5)), HasSubstr("chi-square"));
}

TEST_F(ByHandInRooms, WhatCannotBeForcedSaysWhy) {
  const core::LedgerRow row = row_of(lie(), 5);
  EXPECT_THAT(why_not_forced(accepted(row)), HasSubstr("a loop already"));
  core::LedgerRow lost = row;
  lost.candidate.is_lost = true;
  EXPECT_THAT(why_not_forced(lost), HasSubstr("nobody knew where"));
  core::LedgerRow unmeasured = row;
  unmeasured.verdict = core::Rejection{row.candidate.id, {}, core::Refusal::kPause, "too soon"};
  EXPECT_THAT(why_not_forced(unmeasured), HasSubstr("no relative pose (too soon)"));
  core::LedgerRow elsewhere = row;
  elsewhere.candidate.query = core::FrameId(999);
  EXPECT_THAT(why_not_forced(elsewhere), HasSubstr("frame 999 is no keyframe"));
  EXPECT_THROW(rejected_by_hand(map_, row, config_), core::InputError);
}

// The folder of a finished run through the rooms.
class ByHandInAFolder : public ByHandInRooms {
 protected:
  ByHandInAFolder() {
    map_ = with_next(with_next(map_));
    scene::MapFile::create(folder_.root() / "map.sw", {}).commit(map_, {.frames = frames()});
    folder_.write("config.yaml", "seed: 3\n");
    folder_.write("loops.json", report::loops_json({row_of(true_loop(13, 1), 0)}));
    std::vector<report::FrameRecord> records;
    for (const core::FramePose& pose : frames())
      records.push_back({pose, "a \"name\",\nin lines", core::Rigid3{}});
    records.push_back({{.frame = core::FrameId(records.size()), .stamp_s = 99.0}, "lost", {}});
    folder_.write("frames.csv", report::frames_csv(records));
  }

  std::vector<core::FramePose> frames() const {
    std::vector<core::FramePose> frames;
    for (std::size_t i = 0; i < map_.keyframes.size(); ++i) {
      const core::KeyframeId id(i);
      frames.push_back({.frame = map_.at(id).view.frame,
                        .stamp_s = 0.1 * static_cast<double>(i),
                        .is_measured = true,
                        .reference_keyframe = id});
    }
    return frames;
  }

  core::Trajectory trajectory() const { return core::read_tum(folder_.root() / "trajectory.tum"); }

  input::TestFolder folder_;
};

TEST_F(ByHandInAFolder, ForcingAndRejectingAreWrittenDown) {
  const ChangedRun forced = change_run(folder_.root(), 0, Word::kForce, {});
  EXPECT_EQ(forced.num_loops_before, 0U);
  EXPECT_EQ(forced.num_loops, 1U);
  EXPECT_GT(forced.farthest_m, 0.0);
  EXPECT_TRUE(core::is_loop(ledger_of_run(folder_.root())[0].verdict));
  EXPECT_EQ(scene::MapFile::open(folder_.root() / "map.sw").load().map.loops.size(), 1U);
  const core::Trajectory closed = trajectory();
  EXPECT_EQ(closed.size(), map_.keyframes.size());
  const std::string frames = core::read_file(folder_.root() / "frames.csv");
  EXPECT_THAT(frames,
              HasSubstr(fmt::format("{:.9f}", closed[9].world_from_camera.translation.x())));
  EXPECT_THAT(frames, HasSubstr("99.000000,lost,"));

  const ChangedRun rejected = change_run(folder_.root(), 0, Word::kReject, {});
  EXPECT_EQ(rejected.num_loops, 0U);
  const core::Verdict verdict = ledger_of_run(folder_.root())[0].verdict;
  EXPECT_THAT(core::reason_of(verdict), HasSubstr("by hand"));
  EXPECT_TRUE(report::match_from_query_of(verdict)) << "it may be forced once more";
}

TEST_F(ByHandInAFolder, WhatCannotBeDoneChangesNothing) {
  const std::string before = core::read_file(folder_.root() / "loops.json");
  EXPECT_THROW(change_run(folder_.root(), 1, Word::kForce, {}), core::InputError);
  EXPECT_THROW(change_run(folder_.root(), 0, Word::kReject, {}), core::InputError);
  EXPECT_TRUE(core::read_file(folder_.root() / "loops.json") == before);
  const MapVersion map = scene::MapFile::open(folder_.root() / "map.sw").load().map;
  EXPECT_EQ(map.number, map_.number);
  EXPECT_TRUE(map.loops.empty());
  EXPECT_FALSE(std::filesystem::exists(folder_.root() / "trajectory.tum"));
}

}  // namespace
}  // namespace samewhere::pipeline
