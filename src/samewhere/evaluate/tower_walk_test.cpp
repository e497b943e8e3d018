#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/evaluate/tower_walk.hpp>

namespace samewhere::evaluate {
namespace {

class TowerWalk : public testing::Test {
 protected:
  void SetUp() override { core::make_writable_folder(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::vector<WalkPlace> walk_of(std::string_view text) const {
    core::write_file(folder_ / "walk.txt", text);
    return read_walk(folder_ / "walk.txt");
  }

 private:
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("samewhere_walk_" + std::to_string(getpid()));
};

constexpr const char* kWalk =
    "# image floor clip\n"
    "a/1.jpg floor3 c1\n"
    "a/2.jpg floor3 c1\n"
    "a/3.jpg floor3 c2\n"
    "\n"
    "b/1.jpg floor4 c1\n";

TEST_F(TowerWalk, EveryLoopBetweenTwoFloorsIsWrong) {
  const WalkCounts counts =
      count_walk(walk_of(kWalk), {{1, 0, 1.0}, {2, 0, 1.0}, {3, 0, 1.0}, {3, 2, 1.0}});
  EXPECT_EQ(counts.num_loops, 4);
  EXPECT_EQ(counts.num_false, 2);
  EXPECT_EQ(counts.num_same_floor, 2);
  EXPECT_EQ(counts.num_same_clip, 1);
}

TEST_F(TowerWalk, WithoutClipsEachFloorIsOne) {
  const WalkCounts counts =
      count_walk(walk_of("a.jpg 2\nb.jpg 2\nc.jpg 3\n"), {{1, 0, 1.0}, {2, 0, 1.0}});
  EXPECT_EQ(counts.num_false, 1);
  EXPECT_EQ(counts.num_same_clip, 1);
}

TEST_F(TowerWalk, AShortLineIsNamed) {
  try {
    walk_of("a.jpg floor3 c1\nb.jpg\n");
    FAIL() << "expected an InputError";
  } catch (const core::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("walk.txt, line 2"), std::string::npos);
  }
}

TEST_F(TowerWalk, ALoopOutsideTheWalkIsRefused) {
  EXPECT_THROW(count_walk(walk_of(kWalk), {{4, 0, 1.0}}), core::InputError);
}

}  // namespace
}  // namespace samewhere::evaluate
