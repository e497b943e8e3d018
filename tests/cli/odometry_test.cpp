// `samewhere run --odometry`: what it needs, and what it says where that is missing.

#include <algorithm>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "program.hpp"
#include "test_wall.hpp"
#include <samewhere/core/tum_file.hpp>
#include <samewhere/input/test_folder.hpp>

namespace samewhere::test {
namespace {

using testing::HasSubstr;

// A small TUM RGB-D recording before a painted wall, which turns dark in the middle.
class Odometry : public testing::Test {
 protected:
  Odometry() {
    std::string rgb;
    std::string depth;
    for (int i = 0; i < kNumFrames; ++i) {
      const std::string stamp = fmt::format("{:.3f}", stamp_s(i));
      const bool is_dark = i >= kFirstDark && i <= kLastDark;
      rgb += stamp + fmt::format(" rgb/{}.png\n", i);
      depth += stamp + fmt::format(" depth/{}.png\n", i);
      folder_.write_png(fmt::format("tum/rgb/{}.png", i),
                        is_dark ? cv::Mat(240, 320, CV_8UC3, cv::Scalar::all(0)) : wall());
      folder_.write_png(fmt::format("tum/depth/{}.png", i),
                        cv::Mat(240, 320, CV_16U, cv::Scalar(is_dark ? 0 : 10000)));
    }
    folder_.write("tum/rgb.txt", rgb);
    folder_.write("tum/depth.txt", depth);
    folder_.write("tum/camera.txt", "260 0 160\n0 260 120\n0 0 1\n");
  }

  static double stamp_s(int frame) { return 10.0 + 0.1 * frame; }

  // 1 m/s sideways, at the stamps of the frames from `first` to `last` plus `offset_s`.
  void write_odometry(int first, int last, double offset_s = 0.0) const {
    std::string rows = "# wheels\n";
    for (int i = first; i <= last; ++i)
      rows += fmt::format("{:.3f} {:.3f} 0 0 0 0 0 1\n", stamp_s(i) + offset_s, 0.1 * i);
    folder_.write("wheels.tum", rows);
  }

  Outcome run(const std::string& arguments) const { return run_program(arguments, folder_.root()); }
  Outcome run_tum(const std::string& more = "") const { return run_into("out", more); }
  Outcome run_into(const std::string& folder, const std::string& more) const {
    return run("run " + quoted(path("tum")) + " --odometry " + quoted(path("wheels.tum")) +
               " --out " + quoted(path(folder)) + " " + more);
  }
  std::filesystem::path path(const std::string& name) const { return folder_.root() / name; }

  // One line that names `words`, exit code 2, and no folder left behind.
  void expect_error(const Outcome& outcome, const std::vector<std::string>& words) const {
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    const auto line = outcome.err.rfind("samewhere: ");
    ASSERT_NE(line, std::string::npos) << outcome.err;
    const std::string complaint = outcome.err.substr(line);
    EXPECT_EQ(std::count(complaint.begin(), complaint.end(), '\n'), 1) << complaint;
    for (const auto& word : words) EXPECT_THAT(complaint, HasSubstr(word));
    EXPECT_FALSE(std::filesystem::exists(path("out")));
  }

  static constexpr int kNumFrames = 12;
  static constexpr int kFirstDark = 4;
  static constexpr int kLastDark = 7;
  input::TestFolder folder_;
};

TEST_F(Odometry, FramesInTheDarkHaveThePoseOfTheFile) {
  write_odometry(0, kNumFrames - 1);
  const Outcome outcome = run_tum();
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("12 of 12 (100.0 %)"));
  const core::Trajectory trajectory = core::read_tum(path("out/trajectory.tum"));
  ASSERT_EQ(trajectory.size(), 12U);
  for (int i = 0; i < kNumFrames; ++i)
    EXPECT_NEAR(trajectory[static_cast<std::size_t>(i)].world_from_camera.translation.x(), 0.1 * i,
                1e-6);
  const std::string config = core::read_file(path("out/config.yaml"));
  EXPECT_THAT(config, HasSubstr(path("wheels.tum").string()));
  EXPECT_THAT(config, HasSubstr("sensor: wheel"));
}

TEST_F(Odometry, FramesBeforeTheFileHaveNoPoseAndThoseAfterItThatOfTheImages) {
  write_odometry(2, 9);
  const Outcome outcome = run_tum();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("10 of 12"));
  EXPECT_THAT(outcome.err, HasSubstr("4 of 12 frames have no odometry"));
}

TEST_F(Odometry, AnotherClockIsAnError) {
  for (const double offset_s : {-1000.0, 1e6}) {
    write_odometry(0, kNumFrames - 1, offset_s);
    expect_error(run_tum(), {"wheels.tum", "10.000", "same clock"});
  }
}

TEST_F(Odometry, ABadFileIsAnError) {
  expect_error(run_tum(), {"wheels.tum"});  // there is none
  folder_.write("wheels.tum", "10.0 0 0 0 0 0 0 1\n10.1 0 0 0 0 0 0 2\n");
  expect_error(run_tum(), {"wheels.tum, line 2", "norm 2"});
  folder_.write("wheels.tum", "# no row\n");
  expect_error(run_tum(), {"wheels.tum", "no row"});
}

TEST_F(Odometry, RecognitionAloneHasNoUseForIt) {
  write_odometry(0, kNumFrames - 1);
  expect_error(run("loops " + quoted(path("tum")) + " --out " + quoted(path("out")) +
                   " --set odometry.file=" + quoted(path("wheels.tum"))),
               {"odometry.file", "samewhere run"});
}

TEST_F(Odometry, WithTheProfileOfThePaperItRuns) {
  write_odometry(0, kNumFrames - 1);
  const Outcome outcome = run_tum("--profile paper");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("12 of 12"));
}

TEST_F(Odometry, OfOneCameraItGivesTheScale) {
  write_odometry(0, kNumFrames - 1);
  const Outcome outcome = run_tum("--set input.depth=false");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("12 of 12"));
  EXPECT_THAT(outcome.out, testing::Not(HasSubstr("unknown: one camera")));
}

TEST_F(Odometry, InThreadsAndInTurnItGivesTheSameBytes) {
  write_odometry(0, kNumFrames - 1);
  ASSERT_EQ(run_into("a", "").exit_code, 0);
  ASSERT_EQ(run_into("b", "--set threads=false").exit_code, 0);
  for (const char* file : {"trajectory.tum", "frames.csv", "loops.json", "map.ply"})
    EXPECT_EQ(core::read_file(path(std::string("a/") + file)),
              core::read_file(path(std::string("b/") + file)))
        << file;
}

TEST_F(Odometry, TwinWritesItWithKnownErrorsFromATrajectory) {
  write_odometry(0, kNumFrames - 1);
  const std::string command =
      "twin " + quoted(path("wheels.tum")) + " --odometry " + quoted(path("poor.tum"));
  const Outcome outcome = run(command + " --degrade 5%+slip");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(core::read_tum(path("poor.tum")).size(), 12U);
  const Outcome unknown = run(command + " --degrade bad");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("--degrade bad"));
}

}  // namespace
}  // namespace samewhere::test
