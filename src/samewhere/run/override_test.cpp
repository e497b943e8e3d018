#include <iterator>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/match_from_query.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/input/test_folder.hpp>
#include <samewhere/pipeline/slam.hpp>
#include <samewhere/pipeline/test_rooms.hpp>
#include <samewhere/report/frames.hpp>
#include <samewhere/report/loops.hpp>
#include <samewhere/report/ply.hpp>
#include <samewhere/run/map_export.hpp>
#include <samewhere/run/override.hpp>
#include <samewhere/run/run_folder.hpp>
#include <samewhere/run/run_lists.hpp>

namespace samewhere::run {
namespace {

using scene::MapVersion;
using testing::HasSubstr;

// Verdicts on loop candidates in the two rooms.
class OverrideInRooms : public pipeline::LookAlikeRooms {
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
                                    .match_from_query = core::match_from_query_of(row.verdict)};
    return row;
  }

  std::string why_not_forced(const core::LedgerRow& row) const {
    try {
      with_forced(map_, row, {row}, config_);
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "nothing was said";
  }
};

TEST_F(OverrideInRooms, AForcedLoopCorrectsTheMapAndIsMarkedAsByHand) {
  map_ = with_next(with_next(map_));
  const core::LedgerRow row = row_of(true_loop(13, 1), 3);
  const OverriddenMap changed = with_forced(map_, row, {row}, config_);
  ASSERT_EQ(changed.map.loops.size(), 1U);
  EXPECT_EQ(changed.map.loops[0].cause, core::CandidateId(3));
  EXPECT_LT(rmse_m(changed.map), rmse_m(map_));
  ASSERT_EQ(changed.rows.size(), 1U);
  EXPECT_TRUE(core::is_loop(changed.rows[0].verdict));
  EXPECT_THAT(core::reason_of(changed.rows[0].verdict), HasSubstr("by hand"));
}

TEST_F(OverrideInRooms, ARejectedLoopLeavesTheMapAsIfItHadNeverBeen) {
  const MapVersion with_false = closed(map_, false_loop());
  ASSERT_GT(num_seen_in_both_rooms(with_false), 100);
  const OverriddenMap changed =
      with_rejected(with_false, accepted(row_of(false_loop(), kFalseLoop.index())), config_);
  EXPECT_TRUE(changed.map.loops.empty());
  EXPECT_EQ(survivors(changed.map), survivors(map_));
  ASSERT_EQ(changed.rows.size(), 1U);
  EXPECT_EQ(core::stage_of(changed.rows[0].verdict), "withdrawn");
  EXPECT_THAT(core::reason_of(changed.rows[0].verdict), HasSubstr("by hand"));
}

TEST_F(OverrideInRooms, WhatOdometryAndOtherLoopsContradictIsNotForced) {
  map_ = with_next(with_next(with_next(map_)));
  map_ = closed(closed(map_, true_loop(13, 1)), true_loop(14, 0));
  ASSERT_EQ(map_.loops.size(), 2U);
  EXPECT_THAT(why_not_forced(row_of(false_loop(), 5)), HasSubstr("chi-square"));
}

// Odometry and a true loop against a false one; a loop inside the first room has no part in it.
TEST_F(OverrideInRooms, OtherLoopsWhoseFateItChangesGetTheirOwnRows) {
  map_ = with_next(with_next(with_next(map_)));
  const scene::LoopEdge inside = loop(3, 0, inverse(truth(0)) * truth(3), core::CandidateId(2000));
  const core::LedgerRow inside_row = accepted(row_of(inside, inside.cause.index()));
  const core::LedgerRow false_row = accepted(row_of(false_loop(), kFalseLoop.index()));
  const core::LedgerRow row = row_of(true_loop(13, 1), 5);
  const MapVersion with_false = closed(closed(map_, inside), false_loop());
  ASSERT_EQ(with_false.loops.size(), 2U);
  const OverriddenMap changed = with_forced(with_false, row, {inside_row, false_row, row}, config_);
  ASSERT_EQ(changed.rows.size(), 2U) << "what it leaves as it was gets none";
  EXPECT_EQ(changed.rows[0].candidate.id, row.candidate.id);
  const core::LedgerRow& withdrawn = changed.rows[1];
  EXPECT_EQ(withdrawn.candidate.id, kFalseLoop);
  EXPECT_FALSE(core::is_loop(withdrawn.verdict));
  EXPECT_THAT(core::reason_of(withdrawn.verdict), HasSubstr("candidate 5"));
  EXPECT_TRUE(core::evidence_of(withdrawn.verdict).geometry) << "its evidence is kept";
  EXPECT_EQ(changed.map.loops.size(), 2U);
}

TEST_F(OverrideInRooms, WhatCannotBeForcedSaysWhy) {
  const core::LedgerRow row = row_of(false_loop(), 5);
  EXPECT_THAT(why_not_forced(accepted(row)), HasSubstr("a loop closure already"));
  core::LedgerRow lost = row;
  lost.candidate.origin = core::Origin::kRelocalization;
  EXPECT_THAT(why_not_forced(lost), HasSubstr("is a relocalization candidate"));
  core::LedgerRow unmeasured = row;
  unmeasured.verdict = core::Rejection{row.candidate.id, {}, core::Refusal::kPause, "too soon"};
  EXPECT_THAT(why_not_forced(unmeasured), HasSubstr("no relative pose (too soon)"));
  core::LedgerRow elsewhere = row;
  elsewhere.candidate.query = core::FrameId(999);
  EXPECT_THAT(why_not_forced(elsewhere), HasSubstr("frame 999 is no keyframe"));
  EXPECT_THROW(with_rejected(map_, row, config_), core::InputError);
  lost.verdict = accepted(row).verdict;
  EXPECT_THROW(with_rejected(map_, lost, config_), core::InputError) << "no edge to take back";
}

// The folder of a finished run through the rooms, lost between the two.
class OverrideInAFolder : public OverrideInRooms {
 protected:
  OverrideInAFolder() {
    map_ = with_next(with_next(map_));
    scene::MapFile::create(map_path(), {}).commit(map_, {.frames = frames()});
    folder_.write("config.yaml", "seed: 3\n");
    folder_.write("loops.json", report::loops_json({row_of(true_loop(13, 1), 0)}));
    folder_.write("frames.csv", frames_csv(std::vector<core::StampedPose>(map_.keyframes.size())));
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

  std::string frames_csv(const core::Trajectory& trajectory) const {
    std::vector<report::FrameRecord> records;
    for (const core::FramePose& pose : frames()) {
      if (records.size() == kPerRoom) records.push_back({{.stamp_s = 0.55}, "lost", {}});
      const core::Rigid3& world_from_camera =
          trajectory.at(pose.reference_keyframe.index()).world_from_camera;
      records.push_back({pose, "a \"name\",\nin lines", world_from_camera});
    }
    return report::frames_csv(records);
  }

  // What the files say of the map that is stored by now.
  void expect_files_of_map() const {
    const scene::StoredMap stored = scene::MapFile::open(map_path()).load();
    const core::Trajectory trajectory = pipeline::trajectory_of(stored.map, stored.extras.frames);
    EXPECT_TRUE(text_of("trajectory.tum") == core::tum_text(trajectory));
    EXPECT_TRUE(text_of("frames.csv") == frames_csv(trajectory));
    EXPECT_TRUE(text_of("map.ply") == report::ply_bytes(points_of(stored.map)));
  }

  std::filesystem::path map_path() const { return folder_.root() / "map.sw"; }
  std::string text_of(const char* name) const { return core::read_file(folder_.root() / name); }

  std::size_t num_stored_loops() const {
    return scene::MapFile::open(map_path()).load().map.loops.size();
  }

  std::string why_not_changed(std::size_t candidate, Override override_as) const {
    try {
      override_run(folder_.root(), candidate, override_as, {});
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "nothing was said";
  }

  input::TestFolder folder_;
};

TEST_F(OverrideInAFolder, ACandidateIsShownWithWhatItsViewsShare) {
  const core::LedgerRow row = ledger_of_run(folder_.root())[0];
  const auto why_not_shown = [&] {
    try {
      pair_of_run(folder_.root(), row);
    } catch (const core::InputError& error) {
      return std::string(error.what());
    }
    return std::string("nothing was said");
  };
  EXPECT_THAT(why_not_shown(), HasSubstr("map.sw: has no thumbnail of frame 13"));
  {
    scene::MapFile file = scene::MapFile::open(map_path(), scene::MapAccess::kExtend);
    file.load();
    file.commit(map_, {.thumbnails = {{row.candidate.query, "q"}, {row.candidate.match, "m"}}});
  }
  const report::PairRecord pair = pair_of_run(folder_.root(), row);
  EXPECT_EQ(pair.query.jpeg + pair.match.jpeg, "qm");
  EXPECT_EQ(pair.query.image_size_px, keyframe_of(map_, row.candidate.query)->view.image_size_px);
  EXPECT_GT(pair.matches_px.size(), 20U);
  core::LedgerRow lost = row;
  lost.candidate.origin = core::Origin::kRelocalization;
  EXPECT_THROW(pair_of_run(folder_.root(), lost), core::InputError);
  core::LedgerRow of_no_keyframe = row;
  of_no_keyframe.candidate.match = core::FrameId(999);
  EXPECT_THROW(pair_of_run(folder_.root(), of_no_keyframe), core::InputError);
}

TEST_F(OverrideInAFolder, ForcingAndRejectingAreWrittenDown) {
  const OverriddenRun forced = override_run(folder_.root(), 0, Override::kForce, {});
  EXPECT_EQ(forced.num_loops_before, 0U);
  EXPECT_EQ(forced.num_loops, 1U);
  EXPECT_GT(forced.farthest_m, 0.0);
  EXPECT_TRUE(core::is_loop(ledger_of_run(folder_.root())[0].verdict));
  EXPECT_EQ(num_stored_loops(), 1U);
  expect_files_of_map();

  const OverriddenRun rejected = override_run(folder_.root(), 0, Override::kReject, {});
  EXPECT_EQ(rejected.num_loops, 0U);
  EXPECT_EQ(num_stored_loops(), 0U);
  const core::Verdict verdict = ledger_of_run(folder_.root())[0].verdict;
  EXPECT_THAT(core::reason_of(verdict), HasSubstr("by hand"));
  EXPECT_TRUE(core::match_from_query_of(verdict)) << "it may be forced once more";
  expect_files_of_map();
}

TEST_F(OverrideInAFolder, NothingIsChangedWhileAnotherProgramWritesIntoTheFolder) {
  {
    const core::FolderLock of_another(folder_.root());
    EXPECT_THAT(why_not_changed(0, Override::kForce), HasSubstr("another program is writing"));
  }
  const std::string old_ledger = text_of("loops.json");
  override_run(folder_.root(), 0, Override::kForce, {});
  // cut short: the lists are older than the map
  folder_.write("loops.json", old_ledger);
  folder_.write("loops.json.partial-17-0", "{");
  {
    const core::FolderLock lock(folder_.root());
    ledger_of_run(folder_.root());
    EXPECT_EQ(text_of("loops.json"), old_ledger) << "of another program";
    ledger_in_step(folder_.root(), &lock);
    EXPECT_NE(text_of("loops.json"), old_ledger) << "of the caller";
  }
  EXPECT_FALSE(std::filesystem::exists(folder_.root() / "loops.json.partial-17-0"));
}

// Killed after the map was committed and before, or while, the lists were written.
TEST_F(OverrideInAFolder, ListsThatAreOlderThanTheMapAreWrittenAnew) {
  constexpr const char* kLists[] = {"trajectory.tum", "odometry.tum", "frames.csv", "map.ply",
                                    "loops.json"};
  const std::string old_ledger = text_of("loops.json");
  const std::string old_frames = text_of("frames.csv");
  override_run(folder_.root(), 0, Override::kForce, {});
  std::map<std::string, std::string> written;
  for (const char* name : kLists) written[name] = text_of(name);
  for (const std::size_t num_written : {0U, 1U, 4U}) {
    SCOPED_TRACE(num_written);
    for (std::size_t i = num_written; i < std::size(kLists); ++i)
      folder_.write(kLists[i], "of before the change");
    if (num_written < 3) folder_.write("frames.csv", old_frames);
    folder_.write("loops.json", old_ledger);
    EXPECT_TRUE(core::is_loop(ledger_of_run(folder_.root())[0].verdict));
    for (const char* name : kLists) EXPECT_TRUE(text_of(name) == written[name]) << name;
  }
  // and where it was cut short, it may be changed once more
  folder_.write("loops.json", old_ledger);
  EXPECT_EQ(override_run(folder_.root(), 0, Override::kReject, {}).num_loops, 0U);
  expect_files_of_map();
}

// A full disk ends the saving of a map, not the run: then the lists know more.
TEST_F(OverrideInAFolder, ListsThatKnowMoreThanTheMapStayAsTheyAre) {
  core::LedgerRow later = row_of(true_loop(13, 1), 1);
  later.candidate.query = core::FrameId(12);
  const core::Ledger ledger = {accepted(row_of(true_loop(13, 1), 0)), accepted(later)};
  folder_.write("loops.json", report::loops_json(ledger));
  const std::string before = text_of("loops.json");
  EXPECT_TRUE(core::is_loop(ledger_of_run(folder_.root())[1].verdict));
  EXPECT_TRUE(text_of("loops.json") == before);
}

// What the map says of its ledger may come from anywhere.
TEST_F(OverrideInAFolder, AForgedLedgerInTheMapChangesNoLists) {
  {
    scene::MapFile file = scene::MapFile::open(map_path(), scene::MapAccess::kExtend);
    file.load();
    const std::string deep(100'000, '[');
    file.commit(map_, {.ledger = {R"({"reason": "by hand", "query": )" + deep}});
  }
  const std::string before = text_of("loops.json");
  EXPECT_EQ(ledger_of_run(folder_.root()).size(), 1U);
  EXPECT_TRUE(text_of("loops.json") == before);
}

TEST_F(OverrideInAFolder, WhatCannotBeDoneChangesNothing) {
  const std::string ledger = text_of("loops.json");
  EXPECT_THAT(why_not_changed(1, Override::kForce), HasSubstr("expected 0 to 0"));
  EXPECT_THAT(why_not_changed(0, Override::kReject), HasSubstr(folder_.root().string()));
  folder_.write("frames.csv", report::frames_csv({}));
  EXPECT_THAT(why_not_changed(0, Override::kForce), HasSubstr("0 measured poses; expected 14"));
  EXPECT_TRUE(text_of("loops.json") == ledger);
  EXPECT_EQ(num_stored_loops(), 0U);
  EXPECT_FALSE(std::filesystem::exists(folder_.root() / "trajectory.tum"));
}

TEST_F(OverrideInAFolder, AMapThatAnotherRunHasExtendedIsLeftAlone) {
  {
    scene::MapFile file = scene::MapFile::open(map_path(), scene::MapAccess::kExtend);
    const MapVersion map = file.load().map;
    scene::Edit edit =
        map::start_map(map, features::test_view(world_, 0, map::test_walk(3)), core::Rigid3{});
    edit.keyframes[0].view.frame = core::FrameId(0, 1);
    file.commit(apply(map, edit), {});
  }
  EXPECT_THAT(why_not_changed(0, Override::kForce), HasSubstr("several runs"));
}

}  // namespace
}  // namespace samewhere::run
