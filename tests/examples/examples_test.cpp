// The examples of the library on a short rendered recording, as a user runs them.

#include <algorithm>
#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "program.hpp"

namespace samewhere::test {
namespace {

using testing::HasSubstr;

class Examples : public testing::Test {
 protected:
  // 40 frames, and odometry of the body at each.
  static void SetUpTestSuite() {
    root_ = std::filesystem::path(testing::TempDir()) /
            ("samewhere_examples_" + std::to_string(getpid()));
    std::filesystem::create_directories(root_);
    const std::string walk = "'twin:office-loop?seed=5' --set twin.num_frames=40";
    const Outcome exported = run_program("twin " + walk + " --out " + quoted(path("walk")), root_);
    const Outcome odometry =
        run_program("twin " + walk + " --odometry " + quoted(path("odometry.tum")), root_);
    ASSERT_EQ(exported.exit_code + odometry.exit_code, 0) << exported.err << odometry.err;
    const int status = std::system(("sed -i '/^#/d' " + quoted(path("odometry.tum"))).c_str());
    ASSERT_EQ(status, 0);
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(root_); }

  static std::filesystem::path path(const std::string& name) { return root_ / name; }

  static Outcome run(const std::string& example, const std::string& arguments) {
    const std::string command = "'" SAMEWHERE_EXAMPLES "/" + example + "' " + arguments + " >" +
                                quoted(path("out.txt")) + " 2>" + quoted(path("err.txt"));
    const int status = std::system(command.c_str());
    return {WEXITSTATUS(status), core::read_file(path("out.txt")),
            core::read_file(path("err.txt"))};
  }

  static inline std::filesystem::path root_;
};

TEST_F(Examples, FindLoopsInAFolder) {
  const Outcome outcome = run("01_loops_in_a_folder", quoted(path("walk/rgb")));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
}

TEST_F(Examples, TrackARecording) {
  const Outcome outcome = run("02_live_slam", quoted(path("walk")));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("40 poses"));
  EXPECT_GE(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 41);
}

TEST_F(Examples, LocalizeInASavedMap) {
  const Outcome outcome =
      run("03_localize_in_a_map", quoted(path("walk")) + " " + quoted(path("map.sw")));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("40 frames with a pose"));
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 2);
  EXPECT_TRUE(std::filesystem::exists(path("map.sw")));
}

TEST_F(Examples, CloseLoopsOfOwnOdometry) {
  const Outcome outcome =
      run("04_own_odometry", quoted(path("walk")) + " " + quoted(path("odometry.tum")));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("40 corrected poses"));
}

TEST_F(Examples, DescribeByANetwork) {
  const Outcome outcome = run("05_own_descriptor", quoted(path("walk/rgb")));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string missing = quoted(path("walk/rgb")) + " none.onnx 480 360";
  EXPECT_THAT(run("05_own_descriptor", missing).err, HasSubstr("none.onnx"));
}

TEST_F(Examples, SayInOneLineWhatIsMissing) {
  const Outcome outcome = run("02_live_slam", quoted(path("nothing")));
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("nothing"));
}

}  // namespace
}  // namespace samewhere::test
