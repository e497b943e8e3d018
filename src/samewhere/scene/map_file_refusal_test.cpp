#include <gmock/gmock.h>

#include <samewhere/core/file.hpp>
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
              HasSubstr("m.sw: cannot be opened"));

  std::string bytes = core::read_file(path());
  bytes[63] = 9;  // user_version, big-endian, at 60
  core::write_file(path("new.sw"), bytes);
  EXPECT_THAT(complaint([&] { MapFile::open(path("new.sw")); }),
              HasSubstr("is a samewhere map of version 9; expected version 5"));
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

}  // namespace
}  // namespace samewhere::scene
