#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/input/test_folder.hpp>
#include <samewhere/run/run_folder.hpp>

namespace samewhere::run {
namespace {

TEST(RunFolder, IsNamedByItselfOrByItsMap) {
  const input::TestFolder folder;
  const std::filesystem::path run = folder.root();
  core::write_file(run / "map.sw", "");
  EXPECT_EQ(run_folder_of(run), run);
  EXPECT_EQ(run_folder_of(run / "map.sw"), run);
  EXPECT_EQ(run_folder_of("map.sw"), ".");
  EXPECT_EQ(run_folder_of("not-there"), "not-there");
  EXPECT_EQ(map_file_of(run), run / "map.sw");
  EXPECT_EQ(map_file_of(run / "map.sw"), run / "map.sw");
  EXPECT_EQ(map_file_of("other.sw"), "other.sw");
}

TEST(RunFolder, ANumberThatNoFrameHasIsRefusedByItsLine) {
  const input::TestFolder folder;
  core::write_file(folder.root() / "accepted.txt", "3 1 0.9\n281474976710656 1 0.9\n");
  try {
    evaluate_walk(folder.root(), folder.root() / "walk.txt");
    FAIL() << "it was read";
  } catch (const core::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("accepted.txt, line 2"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace samewhere::run
