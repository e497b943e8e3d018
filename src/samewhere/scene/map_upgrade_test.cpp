#include <gmock/gmock.h>

#include <samewhere/scene/map_tables.hpp>
#include <samewhere/scene/map_upgrade.hpp>
#include <samewhere/scene/test_forged_map.hpp>
#include <samewhere/scene/test_map_file.hpp>

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

  void expect_as_before() {
    MapFile file = MapFile::open(path());
    const StoredMap now = file.load();
    ASSERT_EQ(now.map.keyframes.size(), before_.map.keyframes.size());
    for (std::size_t i = 0; i < now.map.keyframes.size(); ++i)
      EXPECT_TRUE(is_same(now.map.keyframes[i], before_.map.keyframes[i])) << i;
    ASSERT_EQ(now.map.landmarks.size(), before_.map.landmarks.size());
    for (std::size_t i = 0; i < now.map.landmarks.size(); ++i)
      EXPECT_TRUE(is_same(now.map.landmarks[i], before_.map.landmarks[i])) << i;
    ASSERT_EQ(now.map.suspended_loops.size(), before_.map.suspended_loops.size());
    EXPECT_EQ(now.map.suspended_loops.back().query, map_.keyframes[5].id);
    EXPECT_EQ(now.map.number, before_.map.number);
    EXPECT_EQ(now.extras.ledger, before_.extras.ledger);
    EXPECT_EQ(now.extras.frames.size(), before_.extras.frames.size());
    EXPECT_EQ(file.thumbnail(map_.keyframes[2].view.frame), "jpeg");
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
                        "`samewhere map FILE upgrade` makes it"));
}

TEST_F(Upgrade, RewritesTheFileInTheCurrentVersionOnce) {
  EXPECT_TRUE(upgrade_map_file(path()));
  expect_as_before();
  EXPECT_TRUE(MapFile::open(path(), MapAccess::kExtend).is_current());
  EXPECT_FALSE(upgrade_map_file(path()));
  EXPECT_FALSE(std::filesystem::exists(path("m.sw.upgrade")));
}

TEST_F(Upgrade, ADamagedFileStaysAsItIs) {
  run_sql(path(), "UPDATE doubted_loop SET checksum = 1");
  EXPECT_THAT(complaint([&] { upgrade_map_file(path()); }), HasSubstr("is damaged"));
  EXPECT_FALSE(std::filesystem::exists(path("m.sw.upgrade")));
  EXPECT_THAT(complaint([&] { MapFile::open(path()).load(); }), HasSubstr("doubted_loop"));
}

}  // namespace
}  // namespace samewhere::scene
