#include <cstdlib>
#include <cstring>
#include <limits>

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <samewhere/core/file.hpp>
#include <samewhere/features/match_projected.hpp>
#include <samewhere/scene/local_map.hpp>
#include <samewhere/scene/test_forged_maps.hpp>

// Map files are what people exchange: whatever stands in one, with checksums that fit, it is
// refused in one line or can be used.
namespace samewhere::scene {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST_F(ForgedMaps, AreOtherwiseFine) { EXPECT_EQ(complaint_after("SELECT 1"), "none"); }

TEST_F(ForgedMaps, ASizeThatNoPictureHasIsRefused) {
  for (const int side_px : {0, -1, 65536, 1572840, std::numeric_limits<int>::max()}) {
    EXPECT_THAT(complaint_with_view(first_features(), side_px),
                HasSubstr("view 0 is damaged: it has a picture of a size that none has"));
    EXPECT_THAT(complaint_with_view(first_features(), 640, side_px), HasSubstr("size"));
  }
  EXPECT_THAT(complaint_with_view(first_features(), 65535, 65535), HasSubstr("size"));
}

TEST_F(ForgedMaps, FeaturesThatAreNoneAreRefused) {
  const auto with = [&](const auto& change) {
    features::Features f = first_features();
    change(f);
    return complaint_with_view(f);
  };
  for (const float bad : {static_cast<float>(kNaN), static_cast<float>(kInfinity), -2.0F, 1e10F}) {
    EXPECT_THAT(with([&](auto& f) { f.raw_px[1].x() = bad; }), HasSubstr("outside its picture"));
    if (bad != -2.0F) {
      EXPECT_THAT(with([&](auto& f) { f.undistorted_px[1].y() = bad; }), HasSubstr("undistorted"));
    }
    if (bad != 1e10F) {
      EXPECT_THAT(with([&](auto& f) { f.depth_m[1] = bad; }), HasSubstr("depth"));
    }
  }
  EXPECT_THAT(with([](auto& f) { f.right_x_px[0] = 1e30F; }), HasSubstr("right picture"));
  EXPECT_THAT(with([](auto& f) { f.octave[0] = 40; }), HasSubstr("level that no pyramid has"));
  EXPECT_THAT(with([](auto& f) { f.octave[0] = -1; }), HasSubstr("level that no pyramid has"));
  EXPECT_THAT(with([](auto& f) { f.octave.pop_back(); }), HasSubstr("different lengths"));
  EXPECT_THAT(with([](auto& f) { f.descriptors = f.descriptors.colRange(0, 16).clone(); }),
              HasSubstr("different lengths"));
}

TEST_F(ForgedMaps, ARigNeedsACameraThatALensCanHave) {
  const core::Rig rig = *map_.keyframes[0].view.rig;
  EXPECT_THAT(complaint_with("rig", 0, bytes_of(core::Rig{})),
              HasSubstr("rig 0 is damaged: it has no camera"));
  core::Rig two = rig;
  two.cameras.push_back(two.cameras[0]);
  EXPECT_THAT(complaint_with("rig", 0, bytes_of(two)), HasSubstr("number of cameras"));
  using Camera = core::PinholeRadtan;
  for (double Camera::*const number :
       {&Camera::fx_px, &Camera::fy_px, &Camera::cx_px, &Camera::cy_px, &Camera::k1, &Camera::k2,
        &Camera::p1, &Camera::p2, &Camera::k3})
    for (const double bad : {kNaN, kInfinity, 1e100}) {
      core::Rig odd = rig;
      std::get<Camera>(odd.cameras[0]).*number = bad;
      EXPECT_THAT(complaint_with("rig", 0, bytes_of(odd)), HasSubstr("camera that no lens"));
    }
  core::Rig odd = rig;
  std::get<Camera>(odd.cameras[0]).fx_px = 0.0;
  EXPECT_THAT(complaint_with("rig", 0, bytes_of(odd)), HasSubstr("camera that no lens"));
  odd = rig;
  odd.body_from_camera[0].rotation.coeffs() *= 2.0;
  EXPECT_THAT(complaint_with("rig", 0, bytes_of(odd)), HasSubstr("pose"));
  odd = rig;
  odd.body_from_taken_camera.emplace().translation.x() = kNaN;
  EXPECT_THAT(complaint_with("rig", 0, bytes_of(odd)), HasSubstr("before it was turned"));
}

TEST_F(ForgedMaps, PosesAndInformationThatAreNoneAreRefused) {
  const auto with = [&](const auto& change) {
    Keyframe keyframe = map_.keyframes[2];
    change(keyframe);
    return complaint_with("keyframe", 2, bytes_of(keyframe));
  };
  for (const double bad : {kNaN, kInfinity, 1e200}) {
    EXPECT_THAT(with([&](Keyframe& k) { k.world_from_body.translation.x() = bad; }),
                HasSubstr("keyframe 2 is damaged: it has a pose that is none"));
    EXPECT_THAT(with([&](Keyframe& k) { k.world_from_body.rotation.w() = bad; }),
                HasSubstr("pose"));
    EXPECT_THAT(with([&](Keyframe& k) { k.odometry->parent_from_keyframe.translation.y() = bad; }),
                HasSubstr("relative to its parent"));
    EXPECT_THAT(with([&](Keyframe& k) { k.odometry->information(1, 1) = bad; }),
                HasSubstr("positive definite"));
    EXPECT_THAT(with([&](Keyframe& k) { k.log_scale = bad; }), HasSubstr("scale"));
  }
  EXPECT_THAT(with([&](Keyframe& k) { k.odometry->information(0, 1) += 1.0; }),
              HasSubstr("positive definite"));
  EXPECT_THAT(with([&](Keyframe& k) { k.odometry->information.setOnes(); }),
              HasSubstr("positive definite"));
  EXPECT_THAT(with([&](Keyframe& k) { k.odometry->information *= -1.0; }),
              HasSubstr("positive definite"));
}

TEST_F(ForgedMaps, RingsOfParentsAndOfMergesAreRefused) {
  Keyframe keyframe = map_.keyframes[3];
  keyframe.odometry->parent = keyframe.id;
  EXPECT_THAT(complaint_with("keyframe", 3, bytes_of(keyframe)), HasSubstr("not older"));

  ASSERT_GT(map_.merges.size(), 1U);
  Landmark merged = map_.at(map_.merges[0].from);
  merged.merged_into = merged.id;
  EXPECT_THAT(complaint_with("landmark", merged.id.index(), bytes_of(merged)),
              HasSubstr("is not what its landmark says"));

  // both rows of both landmarks say so
  const Landmark a = landmark_that([](const Landmark& l) { return is_live(l); });
  const Landmark b = landmark_that([&](const Landmark& l) { return is_live(l) && l.id != a.id; });
  Merge there = map_.merges[0];
  fresh_copy();
  const std::size_t num_merges = map_.merges.size();
  for (std::size_t i = 0; i < 2; ++i) {
    Landmark from = i == 0 ? a : b;
    from.merged_into = i == 0 ? b.id : a.id;
    forge_row(forged(), "landmark", static_cast<std::int64_t>(from.id.index()), bytes_of(from));
    there.from = from.id;
    there.to = from.merged_into;
    forge_row(forged(), "merge", static_cast<std::int64_t>(num_merges + i), bytes_of(there));
  }
  // whichever is found first: the slots of both, or the ring
  EXPECT_NE(complaint_on_forged(), "none");
}

TEST_F(ForgedMaps, LinksThatDoNotAgreeAreRefused) {
  const Landmark seen = landmark_that([](const Landmark& l) { return is_live(l); });
  const auto with = [&](const auto& change) {
    Landmark landmark = seen;
    change(landmark);
    return complaint_with("landmark", seen.id.index(), bytes_of(landmark));
  };
  EXPECT_THAT(with([](Landmark& l) { l.observations.clear(); }), HasSubstr("does not see it"));
  EXPECT_THAT(with([](Landmark& l) { l.observations.push_back(l.observations[0]); }),
              HasSubstr("seen twice"));
  EXPECT_THAT(with([](Landmark& l) { l.observations[0].slot = -1; }), HasSubstr("not there"));
  EXPECT_THAT(with([](Landmark& l) { l.observations[0].slot += 1; }), HasSubstr("shows another"));
  EXPECT_THAT(with([](Landmark& l) { l.anchor = core::KeyframeId(0, 1); }),
              HasSubstr("hangs on a keyframe that is not there"));
  EXPECT_THAT(with([](Landmark& l) { l.position_in_anchor.z() = kNaN; }), HasSubstr("position"));
  EXPECT_THAT(with([](Landmark& l) { l.range_m = kNaN; }), HasSubstr("range"));
  EXPECT_THAT(with([](Landmark& l) { l.octave = -5; }), HasSubstr("level"));
  ASSERT_FALSE(map_.loops.empty());
  LoopEdge loop = map_.loops[0];
  loop.match = loop.query;
  EXPECT_THAT(complaint_with("loop", 0, bytes_of(loop)), HasSubstr("to itself"));
}

TEST_F(ForgedMaps, ACountThatTheBytesDoNotHoldTakesNoMemory) {
  std::string bytes = bytes_of(std::vector<core::LandmarkId>(3));
  const std::uint64_t forged_count = 24;  // as many as there are bytes
  std::memcpy(bytes.data(), &forged_count, sizeof forged_count);
  EXPECT_THAT(complaint_with("slots", 0, bytes), HasSubstr("slots 0 is damaged: it is cut short"));
  EXPECT_THAT(complaint_after("UPDATE landmark SET bytes = zeroblob(70000000) WHERE number = 0"),
              HasSubstr("forged.sw: "));
}

TEST_F(ForgedMaps, OtherFramesThanTheyAreNumberedByAreRefused) {
  EXPECT_THAT(complaint_after("UPDATE landmark SET number = 100000 WHERE number = 1"),
              HasSubstr("forged.sw: landmark 2 is damaged: it has another number than 1"));
  const StoredMap stored = MapFile::open(path()).load();
  core::FramePose pose = stored.extras.frames[0];
  const auto number = static_cast<std::size_t>(pose.frame.value());
  pose.status = static_cast<core::FrameStatus>(17);
  EXPECT_THAT(complaint_with("frame", number, bytes_of(pose)), HasSubstr("status"));
  pose = stored.extras.frames[1];
  EXPECT_THAT(complaint_with("frame", number, bytes_of(pose)), HasSubstr("another frame"));
  core::Descriptor descriptor = stored.extras.descriptors[0];
  descriptor.unit = {3.0F, 4.0F};
  EXPECT_THAT(complaint_with("descriptor", number, bytes_of(descriptor)),
              HasSubstr("no vector of length 1"));
  descriptor.unit = {1.0F, 0.0F, 0.0F};
  EXPECT_THAT(complaint_with("descriptor", number, bytes_of(descriptor)),
              HasSubstr("several describers"));
}

TEST_F(ForgedMaps, ASchemaWithAnythingMoreIsRefusedAndNotRun) {
  const std::string before = core::read_file(path());
  for (const std::string extra :
       {"CREATE TRIGGER t AFTER INSERT ON state BEGIN DELETE FROM keyframe; END",
        "CREATE VIEW v AS SELECT 1", "CREATE INDEX i ON frame (checksum)", "CREATE TABLE more (a)",
        "CREATE VIRTUAL TABLE words USING fts5(a)", "ALTER TABLE view ADD COLUMN c AS (number)",
        "ALTER TABLE view ADD COLUMN c"})
    EXPECT_THAT(complaint_after(extra), HasSubstr("forged.sw: is damaged: it has a ")) << extra;
  EXPECT_THAT(complaint_after("DROP TABLE ledger"), HasSubstr("lacks 1 of its tables"));
  EXPECT_THAT(
      complaint_after("DROP TABLE merge; CREATE VIEW merge AS WITH RECURSIVE r(n) AS (SELECT "
                      "0 UNION ALL SELECT n FROM r) SELECT n AS number, n AS bytes, n AS "
                      "checksum FROM r"),
      HasSubstr("it has a view merge that no samewhere map has"));
  EXPECT_THAT(complaint_after("UPDATE ledger SET bytes = 'text'"), HasSubstr("another type"));
  EXPECT_THAT(complaint_after("UPDATE ledger SET checksum = 1.5"), HasSubstr("another type"));
  EXPECT_EQ(core::read_file(path()), before);
}

TEST_F(ForgedMaps, ATerminalIsToldNothingByASetting) {
  for (const std::string text : {"a=\x1b[2J", "a\n=b", "a=\xc2\x9b", "a"})
    EXPECT_THAT(complaint_with("header", 0, text), HasSubstr("header 0 is damaged")) << text;
  EXPECT_EQ(complaint_with("header", 0, "name=caf\xc3\xa9"), "none");
}

TEST_F(ForgedMaps, APageThatTwoThingsClaimIsRefused) {
  EXPECT_THAT(
      complaint_after("PRAGMA writable_schema=ON; UPDATE sqlite_schema SET rootpage = "
                      "(SELECT rootpage FROM sqlite_schema WHERE name = 'loop') WHERE name = "
                      "'merge'"),
      HasSubstr("forged.sw: is damaged: "));
}

TEST_F(ForgedMaps, WhatIsNoFileIsRefusedAtOnce) {
  ASSERT_EQ(mkfifo(path("pipe.sw").c_str(), 0600), 0);
  for (const MapAccess access : {MapAccess::kRead, MapAccess::kExtend}) {
    EXPECT_THAT(complaint([&] { MapFile::open(path("pipe.sw"), access); }),
                HasSubstr("pipe.sw: is no samewhere map"));
    EXPECT_THAT(complaint([&] { MapFile::open("/dev/zero", access); }),
                HasSubstr("/dev/zero: is no samewhere map"));
  }
  std::filesystem::resize_file(path(), std::uintmax_t{1} << 40);
  EXPECT_THAT(complaint([&] { MapFile::open(path()); }), HasSubstr("it has 1024 GiB; expected 64"));
}

}  // namespace
}  // namespace samewhere::scene
