#include <cstdlib>
#include <cstring>
#include <limits>

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <samewhere/core/file.hpp>
#include <samewhere/features/match_projected.hpp>
#include <samewhere/scene/local_map.hpp>
#include <samewhere/scene/map_rows.hpp>
#include <samewhere/scene/test_forged_map.hpp>
#include <samewhere/scene/test_map_file.hpp>

// Map files are what people exchange: whatever stands in one, with checksums that fit, it is
// refused in one line or can be used.
namespace samewhere::scene {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

class ForgedMaps : public MapFiles {
 protected:
  ForgedMaps() {
    MapFile file = MapFile::create(path(), {{"features.num_features", "1000"}});
    RandomEdits edits(7);
    core::Random random(7);
    for (int i = 0; i < kNumKeyframes; ++i) {
      map_ = apply(std::move(map_), edits.next(map_));
      MapExtras extras = extras_of(map_, random);
      extras.thumbnails = {{map_.keyframes.back().view.frame, "a picture"}};
      file.commit(map_, extras);
    }
  }

  std::filesystem::path forged() const { return path("forged.sw"); }

  void fresh_copy() const {
    std::filesystem::copy_file(path(), forged(), std::filesystem::copy_options::overwrite_existing);
  }

  std::string complaint_on_forged() const {
    return complaint([&] { MapFile::open(forged()).load(); });
  }

  std::string complaint_after(const std::string& sql) const {
    fresh_copy();
    run_sql(forged(), sql);
    return complaint_on_forged();
  }

  // Of a copy of the map in which the row has other bytes.
  std::string complaint_with(const char* table, std::size_t number, std::string_view bytes) const {
    fresh_copy();
    forge_row(forged(), table, static_cast<std::int64_t>(number), bytes);
    return complaint_on_forged();
  }
  // Whose view has other features or another picture.
  std::string complaint_with_view(const features::Features& f, int width_px = 640,
                                  int height_px = 480) const {
    ByteWriter writer;
    writer(map_.keyframes[0].view.frame, 0.0, std::uint64_t{0}, width_px, height_px, f);
    return complaint_with("view", 0, writer.bytes());
  }

  features::Features first_features() const { return *map_.keyframes[0].view.features; }

  template <class IsIt>
  Landmark landmark_that(const IsIt& is_it) const {
    for (std::size_t i = 0; i < map_.landmarks.size(); ++i)
      if (is_it(map_.landmarks[i])) return map_.landmarks[i];
    throw std::runtime_error("the map has no such landmark");
  }

  MapVersion map_;
};

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

// Numbers that break what reads them.
class Forger {
 public:
  Forger(const std::filesystem::path& path, std::uint64_t seed) : path_(path), random_(seed) {}

  // One row of one table becomes another. What was done, for a message.
  std::string forge() {
    table_ = kTables[random_.index(std::size(kTables))];
    const auto numbers = run_sql(path_, fmt::format("SELECT number FROM {}", table_));
    if (numbers.empty()) return "nothing";
    number_ = std::stoll(numbers[random_.index(numbers.size())]);
    const std::uint64_t kind = random_.index(12);
    if (kind == 0) return by_sql("DELETE FROM {0} WHERE number = {1}");
    if (kind == 1) return by_sql("UPDATE {0} SET number = number + 1000000 WHERE number = {1}");
    if (kind == 2)
      return by_sql("UPDATE {0} SET bytes = 'text', checksum = 0.5 WHERE number = {1}");
    if (kind == 3) return by_sql("UPDATE {0} SET number = -number - 1 WHERE number = {1}");
    std::string bytes = bytes_at(number_);
    if (kind == 4) bytes = bytes_at(std::stoll(numbers[random_.index(numbers.size())]));
    if (kind == 5) bytes.resize(random_.index(bytes.size() + 1));
    if (kind == 6) bytes.append(1 + random_.index(40), '\1');
    if (kind >= 7) overwrite(bytes);
    forge_row(path_, table_, number_, bytes);
    return fmt::format("{} {}, kind {}", table_, number_, kind);
  }

 private:
  static constexpr const char* kTables[] = {
      "header", "state",          "rig",   "keyframe", "view",       "slots",  "landmark",
      "loop",   "suspended_loop", "merge", "frame",    "descriptor", "ledger", "thumbnail"};

  std::string by_sql(const char* sql) {
    run_sql(path_, fmt::format(fmt::runtime(sql), table_, number_));
    return fmt::format(fmt::runtime(sql), table_, number_);
  }

  std::string bytes_at(std::int64_t number) const {
    const std::string hex = run_sql(
        path_, fmt::format("SELECT hex(bytes) FROM {} WHERE number = {}", table_, number))[0];
    std::string bytes;
    for (std::size_t i = 0; i < hex.size(); i += 2)
      bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
    return bytes;
  }

  template <class T>
  void put(std::string& bytes, T value) {
    if (bytes.size() < sizeof value) return;
    const std::size_t at = random_.index(bytes.size() - sizeof value + 1);
    std::memcpy(bytes.data() + at - at % (random_.index(2) == 0 ? sizeof value : 1), &value,
                sizeof value);
  }

  void overwrite(std::string& bytes) {
    constexpr double kDoubles[] = {kNaN,   kInfinity, -kInfinity, 0.0,   -1.0, 1e300,
                                   1e-300, 1e100,     1e30,       -1e12, 2.0,  0.5};
    constexpr std::int64_t kNumbers[] = {0, 1, 2, 3, 5, 9, -1, -2, 1 << 20, 1LL << 32, 1LL << 48};
    for (std::uint64_t i = 0; i <= random_.index(2); ++i) {
      const std::uint64_t kind = random_.index(4);
      if (kind == 0) put(bytes, kDoubles[random_.index(std::size(kDoubles))]);
      if (kind == 1) put(bytes, kNumbers[random_.index(std::size(kNumbers))]);
      if (kind == 2) put(bytes, static_cast<float>(kDoubles[random_.index(std::size(kDoubles))]));
      if (kind == 3) put(bytes, static_cast<std::int32_t>(random_.next()));
    }
  }

  std::filesystem::path path_;
  core::Random random_;
  std::string table_;
  std::int64_t number_ = 0;
};

// Everything that reads a map.
void use(MapVersion map) {
  const features::Config config;
  odometry_poses(map);
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const core::KeyframeId id = map.keyframes[i].id;
    const LocalMap local = build_local_map(map, holder_of(map, id).keyframe, {5, 2});
    features::match_projected({{0, {10.0, 10.0}, 1}}, cv::Mat::zeros(1, 32, CV_8U), map.at(id).view,
                              20.0, config);
    keyframe_showing_most(map, local.landmarks);
    for (int k = 0; k < local.size(); ++k)
      features::octave_at(local.octave[static_cast<std::size_t>(k)],
                          local.range_m[static_cast<std::size_t>(k)], 1.0, config);
  }
  for (std::size_t i = 0; i < map.landmarks.size(); ++i)
    position_in_world(map, survivor_of(map, map.landmarks[i].id));
  while (!map.loops.empty()) {
    Edit edit;
    edit.withdrawn_loops = {map.loops.back().cause};
    map = apply(std::move(map), edit);
  }
  Edit culling;
  for (std::size_t i = 0; i < map.keyframes.size() && culling.culled_keyframes.empty(); ++i)
    if (is_live(map.keyframes[i]) && map.keyframes[i].odometry)
      culling.culled_keyframes = {map.keyframes[i].id};
  apply(std::move(map), culling);
}

// More of them: SAMEWHERE_FORGERIES=100000 build/dev/samewhere_scene_test --gtest_filter=Forged*
TEST_F(ForgedMaps, AnyForgedRowIsRefusedInALineOrCanBeUsed) {
  const char* wanted = std::getenv("SAMEWHERE_FORGERIES");
  const int num_forgeries = wanted == nullptr ? 40 : std::atoi(wanted);
  int num_refused = 0;
  for (int i = 0; i < num_forgeries; ++i) {
    fresh_copy();
    SCOPED_TRACE(
        fmt::format("seed {}: {}", i, Forger(forged(), static_cast<std::uint64_t>(i)).forge()));
    std::string found = "nothing was said";
    try {
      MapFile file = MapFile::open(forged(), MapAccess::kExtend);
      const StoredMap stored = file.load();
      found = "none";
      use(stored.map);
      file.commit(stored.map, {.ledger = {"{}"}});
    } catch (const core::InputError& error) {
      EXPECT_NE(found, "none") << "refused when it was used: " << error.what();
      EXPECT_THAT(error.what(), AllOf(HasSubstr("forged.sw"), testing::Not(HasSubstr("\n"))));
      ++num_refused;
      continue;
    } catch (const std::exception& error) {
      FAIL() << error.what();
    }
    EXPECT_EQ(complaint_on_forged(), "none") << "what was committed can be read";
  }
  EXPECT_GT(num_refused, num_forgeries / 3) << "the rest changed what may be anything";
}

}  // namespace
}  // namespace samewhere::scene
