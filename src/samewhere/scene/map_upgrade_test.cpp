#include <csignal>

#include <gmock/gmock.h>
#include <sys/wait.h>

#include <samewhere/core/file.hpp>
#include <samewhere/scene/map_upgrade.hpp>
#include <samewhere/scene/test_forged_map.hpp>
#include <samewhere/scene/test_map_file.hpp>
#include <samewhere/scene/writer_lock.hpp>

namespace samewhere::scene {
namespace {

using testing::HasSubstr;

// The file as version 6 had it: its table of suspended loops had another name, which is part of the
// checksum of each row.
void make_version_6(const std::filesystem::path& path) {
  const auto numbers = run_sql(path, "SELECT number FROM suspended_loop ORDER BY number");
  const auto bytes = run_sql(path, "SELECT hex(bytes) FROM suspended_loop ORDER BY number");
  run_sql(path,
          "CREATE TABLE doubted_loop (number INTEGER PRIMARY KEY, bytes BLOB NOT NULL, checksum "
          "INTEGER NOT NULL)");
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    std::string raw;
    for (std::size_t k = 0; k < bytes[i].size(); k += 2)
      raw += static_cast<char>(std::stoi(bytes[i].substr(k, 2), nullptr, 16));
    forge_row(path, "doubted_loop", std::stoll(numbers[i]), raw);
  }
  run_sql(path, "DROP TABLE suspended_loop; PRAGMA user_version = 6");
}

class Upgrade : public MapFiles {
 protected:
  // With a suspended loop and a thumbnail, and what was read of it before.
  void SetUp() override {
    map_ = write_small_map();
    {
      MapFile file = MapFile::open(path(), MapAccess::kExtend);
      file.load();
      LoopEdge suspended;
      suspended.query = map_.keyframes[5].id;
      suspended.match = map_.keyframes[1].id;
      suspended.cause = core::CandidateId(0, 3);
      map_.suspended_loops.push_back(suspended);
      MapExtras extras;
      extras.thumbnails.push_back({map_.keyframes[2].view.frame, "jpeg"});
      file.commit(map_, extras);
    }
    before_ = MapFile::open(path()).load();
    make_version_6(path());
  }

  void expect_as_before(const std::string& thumbnail = "jpeg") {
    MapFile file = MapFile::open(path());
    const StoredMap now = file.load();
    expect_same(now.map, before_.map);
    expect_same(now.extras, before_.extras);
    EXPECT_EQ(now.map.suspended_loops.back().query, map_.keyframes[5].id);
    EXPECT_EQ(file.thumbnail(map_.keyframes[2].view.frame), thumbnail);
    EXPECT_EQ(file.header().at("features.num_features"), "1000");
  }

  MapVersion map_;
  StoredMap before_;
};

TEST_F(Upgrade, TheVersionBeforeIsRead) {
  expect_as_before();
  EXPECT_FALSE(MapFile::open(path()).is_current());
}

TEST_F(Upgrade, TheVersionBeforeIsNotWritten) {
  EXPECT_THAT(complaint([&] { MapFile::open(path(), MapAccess::kExtend); }),
              HasSubstr("is a samewhere map of version 6, which is read only; expected version 7: "
                        "`samewhere map FILE upgrade` rewrites it"));
}

TEST_F(Upgrade, RewritesTheFileInTheCurrentVersionOnce) {
  EXPECT_TRUE(upgrade_map_file(path()));
  expect_as_before();
  EXPECT_TRUE(MapFile::open(path(), MapAccess::kExtend).is_current());
  EXPECT_FALSE(upgrade_map_file(path()));
  EXPECT_FALSE(std::filesystem::exists(path("m.sw.partial-upgrade")));
}

// A program of then was killed: its last commit is in the log.
TEST_F(Upgrade, TheLogOfAKilledProgramIsPartOfTheFile) {
  const pid_t child = fork();
  if (child == 0) {
    const auto frame = static_cast<std::int64_t>(map_.keyframes[2].view.frame.value());
    const std::string sql = fmt::format(
        "PRAGMA journal_mode=WAL; INSERT OR REPLACE INTO thumbnail VALUES ({}, x'{}', {})", frame,
        hex_of("later"), forged_checksum("thumbnail", frame, "later"));
    sqlite3* connection = nullptr;
    sqlite3_open(path().c_str(), &connection);
    sqlite3_exec(connection, sql.c_str(), nullptr, nullptr, nullptr);
    kill(getpid(), SIGKILL);
  }
  waitpid(child, nullptr, 0);
  ASSERT_TRUE(std::filesystem::exists(path("m.sw-wal"))) << "without it this shows nothing";
  EXPECT_TRUE(upgrade_map_file(path()));
  expect_as_before("later");
  EXPECT_TRUE(MapFile::open(path()).is_current());
}

TEST_F(Upgrade, WhatACrashLeftIsReplaced) {
  core::write_file(path("m.sw.partial-upgrade"), "half a map");
  EXPECT_TRUE(upgrade_map_file(path()));
  expect_as_before();
}

TEST_F(Upgrade, AFileThatAnotherProgramWritesIsRefused) {
  const WriterLock other(path(), WriterLock::File::kIsThere);
  EXPECT_THAT(complaint([&] { upgrade_map_file(path()); }),
              HasSubstr("another program is writing"));
}

TEST_F(Upgrade, ADamagedFileStaysAsItIs) {
  run_sql(path(), "UPDATE doubted_loop SET checksum = 1");
  EXPECT_THAT(complaint([&] { upgrade_map_file(path()); }), HasSubstr("is damaged"));
  EXPECT_FALSE(std::filesystem::exists(path("m.sw.partial-upgrade")));
  EXPECT_THAT(complaint([&] { MapFile::open(path()).load(); }), HasSubstr("doubted_loop"));
}

}  // namespace
}  // namespace samewhere::scene
