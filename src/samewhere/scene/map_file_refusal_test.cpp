#include <gmock/gmock.h>

#include <samewhere/core/file.hpp>
#include <samewhere/scene/test_forged_map.hpp>
#include <samewhere/scene/test_map_file.hpp>

namespace samewhere::scene {
namespace {

using testing::HasSubstr;

TEST_F(MapFiles, WhatIsNoMapIsToldApart) {
  EXPECT_THAT(complaint([&] { MapFile::open(path("nowhere.sw")); }),
              HasSubstr("nowhere.sw: no such file; expected a samewhere map"));
  core::write_file(path("text.sw"), "a text that is long enough to be something");
  EXPECT_THAT(complaint([&] { MapFile::open(path("text.sw")); }),
              HasSubstr("text.sw: is no samewhere map"));
  core::write_file(path("empty.sw"), "");
  EXPECT_THAT(complaint([&] { MapFile::open(path("empty.sw")); }),
              HasSubstr("is no samewhere map"));
  EXPECT_THAT(complaint([&] { MapFile::open(folder_); }), HasSubstr("is no samewhere map"));
  write_small_map();
  EXPECT_THAT(complaint([&] { MapFile::create(path(), {}); }),
              HasSubstr("m.sw: is there already; expected a new file"));
  EXPECT_THAT(complaint([&] { MapFile::create(path("no/folder/m.sw"), {}); }),
              HasSubstr("m.sw: cannot be written"));

  std::string bytes = core::read_file(path());
  bytes[63] = 9;  // user_version, big-endian, at 60
  core::write_file(path("new.sw"), bytes);
  EXPECT_THAT(complaint([&] { MapFile::open(path("new.sw")); }),
              HasSubstr("is a samewhere map of version 9; expected version 6 or 7"));
  bytes[68] ^= 1;  // application_id
  core::write_file(path("other.sw"), bytes);
  EXPECT_THAT(complaint([&] { MapFile::open(path("other.sw")); }),
              HasSubstr("is no samewhere map but another SQLite file"));
}

TEST_F(MapFiles, OtherSettingsAreNamedWithBothValues) {
  write_small_map();
  const MapFile file = MapFile::open(path());
  EXPECT_EQ(complaint([&] {
              file.require_same_settings({{"features.num_features", "1000"}});
            }),
            "none");
  EXPECT_EQ(
      complaint([&] {
        file.require_same_settings({{"features.num_features", "500"}});
      }),
      path().string() + ": the map was made with features.num_features = 1000; this run has 500");
  EXPECT_THAT(complaint([&] {
                file.require_same_settings({{"describer", "hog"}});
              }),
              HasSubstr("made with describer = unknown; this run has hog"));
}

TEST_F(MapFiles, ARefusedWriterLeavesTheFileUnchanged) {
  write_small_map();
  const std::string before = core::read_file(path());
  {
    MapFile file = MapFile::open(path(), MapAccess::kExtend);
    file.load();
    EXPECT_NE(complaint([&] { file.require_same_settings({{"describer", "hog"}}); }), "none");
  }
  EXPECT_TRUE(core::read_file(path()) == before);
}

TEST_F(MapFiles, AFileThatCannotHaveALogIsSaidBeforeTheFirstCommit) {
  write_small_map();
  MapFile file = MapFile::open(path(), MapAccess::kExtend);
  file.load();
  std::filesystem::create_directory(path("m.sw-wal"));
  EXPECT_THAT(complaint([&] { file.begin_writing(); }), HasSubstr("m.sw: cannot be opened"));
}

TEST_F(MapFiles, OneProgramWritesAtATime) {
  write_small_map();
  {
    const MapFile writing = MapFile::open(path(), MapAccess::kExtend);
    EXPECT_THAT(complaint([&] { MapFile::open(path(), MapAccess::kExtend); }),
                HasSubstr("m.sw: another program is writing to this map"));
    EXPECT_EQ(complaint([&] { MapFile::open(path()).load(); }), "none") << "others may read";
  }
  EXPECT_EQ(complaint([&] { MapFile::open(path(), MapAccess::kExtend); }), "none");
}

// What the lock did not keep out: some network drives know none.
TEST_F(MapFiles, WhatAnotherHasWrittenMeanwhileIsNotWrittenOver) {
  MapVersion map = write_small_map();
  std::filesystem::copy_file(path(), path("later.sw"));
  RandomEdits edits(2);
  map = apply(std::move(map), edits.next(map));
  {
    MapFile later = MapFile::open(path("later.sw"), MapAccess::kExtend);
    later.load();
    later.commit(map, {});
  }
  MapFile file = MapFile::open(path(), MapAccess::kExtend);
  file.load();
  run_sql(path(), "ATTACH '" + path("later.sw").string() +
                      "' AS later; INSERT OR REPLACE INTO state SELECT * FROM later.state");
  EXPECT_THAT(complaint([&] { file.commit(map, {}); }),
              HasSubstr("m.sw: another program has written to this map meanwhile"));
}

}  // namespace
}  // namespace samewhere::scene
