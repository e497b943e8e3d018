#include <csignal>

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <samewhere/core/file.hpp>
#include <samewhere/scene/test_map_file.hpp>

namespace samewhere::scene {
namespace {

using testing::HasSubstr;

TEST_F(MapFiles, AKilledProgramLeavesTheMapOfItsLastCommit) {
  const pid_t child = fork();
  if (child == 0) {
    write_small_map();
    MapFile file = MapFile::open(path(), MapAccess::kExtend);
    MapVersion map = file.load().map;
    RandomEdits edits(2);
    map = apply(map, edits.next(map));
    file.commit(map, {});
    kill(getpid(), SIGKILL);  // nothing is closed, the log lies beside the file
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  ASSERT_TRUE(std::filesystem::exists(path("m.sw-wal"))) << "without a log this shows nothing";
  const StoredMap stored = MapFile::open(path()).load();
  EXPECT_EQ(stored.map.keyframes.size(), kNumKeyframes + 1U);
  EXPECT_EQ(stored.map.number, kNumKeyframes + 1U);
}

TEST_F(MapFiles, AFullDiskIsSaidAndTheLastCommitStays) {
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = before;
  small.rlim_cur = 300'000;  // bytes that a file may have
  std::string found;
  std::uint64_t num_committed = 0;
  {
    MapFile file = MapFile::create(path(), {});
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    RandomEdits edits(4);
    MapVersion map;
    found = complaint([&] {
      while (num_committed < 1000) {
        map = apply(std::move(map), edits.next(map));
        file.commit(map, {});
        ++num_committed;
      }
    });
  }
  EXPECT_FALSE(std::filesystem::exists(path("m.sw-wal"))) << "its space is given back";
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_THAT(found, HasSubstr("m.sw: cannot be")) << found;
  EXPECT_GT(num_committed, 5U);
  EXPECT_EQ(MapFile::open(path()).load().map.number, num_committed);
}

TEST_F(MapFiles, DamageIsFoundAndNamedWhereverItIs) {
  const MapVersion map = write_small_map();
  const std::string whole = core::read_file(path());
  core::Random random(5);
  int num_found = 0;
  constexpr int kNumTries = 100;
  for (int i = 0; i < kNumTries; ++i) {
    std::string bytes = whole;
    const std::uint64_t at = random.index(bytes.size());
    SCOPED_TRACE("byte " + std::to_string(at));
    if (i % 5 == 0) {
      bytes.resize(at);
    } else {
      bytes[at] = static_cast<char>(bytes[at] ^ (1 + random.index(255)));
    }
    core::write_file(path("hurt.sw"), bytes);
    StoredMap stored;
    const std::string found = complaint([&] { stored = MapFile::open(path("hurt.sw")).load(); });
    if (found == "none") {
      expect_same(stored.map, map);  // bytes that are not read were hit
    } else {
      ++num_found;
      EXPECT_THAT(found, HasSubstr("hurt.sw: ")) << found;
      EXPECT_EQ(found.find('\n'), std::string::npos) << found;
    }
  }
  EXPECT_GT(num_found, kNumTries / 3);  // the rest hit what no row uses
}

TEST_F(MapFiles, ALandmarkThatChangedItsBytesIsNamed) {
  const MapVersion map = write_small_map();
  std::string bytes = core::read_file(path());
  const auto& descriptor = map.landmarks[2].descriptor;
  const std::size_t at =
      bytes.find(std::string(reinterpret_cast<const char*>(descriptor.data()), descriptor.size()));
  ASSERT_NE(at, std::string::npos);
  bytes[at] ^= 1;
  // the bytes are those of the landmark or of the feature it was made of
  core::write_file(path(), bytes);
  EXPECT_THAT(complaint([&] { MapFile::open(path()).load(); }),
              testing::ContainsRegex(
                  R"(m\.sw: (landmark|view) [0-9]+ is damaged: its checksum does not fit)"));
}

}  // namespace
}  // namespace samewhere::scene
