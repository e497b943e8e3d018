#include <csignal>

#include <gmock/gmock.h>
#include <sys/mount.h>
#include <sys/wait.h>

#include <samewhere/core/file.hpp>
#include <samewhere/scene/test_forged_map.hpp>
#include <samewhere/scene/test_map_file.hpp>

// What a killed program and a full disk leave beside a map.
namespace samewhere::scene {
namespace {

using testing::HasSubstr;

// A journal that a program was killed with while it changed how the file is written.
class KilledInTheChange : public MapFiles {
 protected:
  KilledInTheChange() {
    before_ = write_small_map();
    const pid_t child = fork();
    if (child == 0) {
      sqlite3* connection = nullptr;
      sqlite3_open(path().c_str(), &connection);
      // the pages go into the file before the transaction ends
      sqlite3_exec(connection,
                   "PRAGMA cache_size=1; PRAGMA cache_spill=1; BEGIN; UPDATE landmark SET bytes = "
                   "zeroblob(300); UPDATE view SET bytes = zeroblob(3000);",
                   nullptr, nullptr, nullptr);
      kill(getpid(), SIGKILL);
    }
    waitpid(child, nullptr, 0);
  }

  MapVersion before_;
};

TEST_F(KilledInTheChange, TheMapOpensForReadersAsItWas) {
  ASSERT_TRUE(std::filesystem::exists(path("m.sw-journal"))) << "without it this shows nothing";
  expect_same(MapFile::open(path()).load().map, before_);
  EXPECT_FALSE(std::filesystem::exists(path("m.sw-journal"))) << "put in order for all";
}

// As in a folder that cannot be written: the map is read from a copy.
TEST_F(KilledInTheChange, WhereItCannotBePutInOrderACopyIs) {
  const std::string bytes = core::read_file(path());
  if (getuid() == 0) {
    GTEST_SKIP()
        << "root can write in any folder; tests/outside/kills tries it on a read-only disk";
  }
  std::filesystem::permissions(folder_, std::filesystem::perms::owner_write,
                               std::filesystem::perm_options::remove);
  expect_same(MapFile::open(path()).load().map, before_);
  std::filesystem::permissions(folder_, std::filesystem::perms::owner_write,
                               std::filesystem::perm_options::add);
  EXPECT_EQ(core::read_file(path()), bytes);
}

// A small disk of its own, where this user can make one.
TEST_F(MapFiles, AFullDiskHoldsTheMapAndNoLog) {
  const std::filesystem::path disk = path("disk");
  std::filesystem::create_directory(disk);
  if (mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=512k") != 0)
    GTEST_SKIP() << "no disk can be made";
  std::string found;
  std::uint64_t num_committed = 0;
  {
    MapFile file = MapFile::create(disk / "m.sw", {});
    RandomEdits edits(4);
    MapVersion map;
    found = complaint([&] {
      while (num_committed < 2000) {
        map = apply(std::move(map), edits.next(map));
        file.commit(map, {});
        ++num_committed;
      }
    });
  }
  EXPECT_THAT(found, HasSubstr("m.sw: cannot be written: no space left on the disk"));
  EXPECT_FALSE(std::filesystem::exists(disk / "m.sw-wal"));
  EXPECT_GT(std::filesystem::file_size(disk / "m.sw"), 200'000U) << "most of the disk";
  EXPECT_EQ(complaint([&] { num_committed -= MapFile::open(disk / "m.sw").load().map.number; }),
            "none");
  EXPECT_EQ(num_committed, 0U);
  EXPECT_EQ(umount(disk.c_str()), 0);
}

TEST_F(MapFiles, TheLogOfAMapThatIsGoneIsNotTakenForThatOfANewOne) {
  write_small_map();
  const std::string bytes = core::read_file(path());
  for (const char* log : {"n.sw-wal", "n.sw-journal"}) core::write_file(path(log), bytes);
  MapVersion map;
  RandomEdits edits(2);
  map = apply(std::move(map), edits.next(map));
  MapFile::create(path("n.sw"), {}).commit(map, {});
  expect_same(MapFile::open(path("n.sw")).load().map, map);
}

TEST_F(MapFiles, ANewMapAppearsWithItsHeaderOrNotAtAll) {
  std::filesystem::create_directory(path("m.sw-wal"));  // so that it cannot be opened
  EXPECT_THAT(complaint([&] { MapFile::create(path(), {}); }), HasSubstr("m.sw: cannot be opened"));
  EXPECT_FALSE(std::filesystem::exists(path()));
  std::filesystem::create_symlink(path("elsewhere.sw"), path("link.sw"));
  EXPECT_THAT(complaint([&] { MapFile::create(path("link.sw"), {}); }),
              HasSubstr("link.sw: is there already"));
  EXPECT_FALSE(std::filesystem::exists(path("elsewhere.sw"))) << "no link is followed";
}

}  // namespace
}  // namespace samewhere::scene
