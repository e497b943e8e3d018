// Bad input ends with one clear line on stderr, exit code 2, and no crash.

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "program.hpp"
#include "test_wall.hpp"
#include <samewhere/input/test_folder.hpp>

namespace samewhere::test {
namespace {

// A small TUM RGB-D recording of a wall of random squares that the camera does not move before.
class BadInput : public testing::Test {
 protected:
  BadInput() {
    std::string rgb = "# color images\n# file\n# timestamp filename\n";
    std::string depth = rgb;
    std::string truth = "# timestamp tx ty tz qx qy qz qw\n";
    for (int i = 0; i < kNumFrames; ++i) {
      const std::string stamp = "10." + std::to_string(10 + i);
      rgb += stamp + " rgb/" + std::to_string(i) + ".png\n";
      depth += stamp + " depth/" + std::to_string(i) + ".png\n";
      truth += stamp + " 0 0 0 0 0 0 1\n";
      folder_.write_png("tum/rgb/" + std::to_string(i) + ".png", wall());
      folder_.write_png("tum/depth/" + std::to_string(i) + ".png",
                        cv::Mat(240, 320, CV_16U, cv::Scalar(10000)));
    }
    folder_.write("tum/rgb.txt", rgb);
    folder_.write("tum/depth.txt", depth);
    folder_.write("tum/groundtruth.txt", truth);
    folder_.write("tum/camera.txt", "260 0 160\n0 260 120\n0 0 1\n");
  }

  Outcome run(const std::string& arguments) const { return run_program(arguments, folder_.root()); }
  Outcome run_tum(const std::string& more = "") const {
    return run("run " + quoted(source()) + " --out " + quoted(out()) + " " + more);
  }
  std::filesystem::path source() const { return folder_.root() / "tum"; }
  std::filesystem::path out() const { return folder_.root() / "out"; }

  // One line that names `words`, exit code 2.
  static void expect_clear_error(const Outcome& outcome, const std::vector<std::string>& words) {
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    const auto line = outcome.err.rfind("samewhere: ");
    ASSERT_NE(line, std::string::npos) << outcome.err;
    const std::string complaint = outcome.err.substr(line);
    EXPECT_EQ(std::count(complaint.begin(), complaint.end(), '\n'), 1) << complaint;
    for (const auto& word : words)
      EXPECT_NE(complaint.find(word), std::string::npos) << word << " in: " << complaint;
  }

  // The run goes on, and says what it left out.
  static void expect_warning(const Outcome& outcome, const std::vector<std::string>& words) {
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    for (const auto& word : words) EXPECT_THAT(outcome.err, testing::HasSubstr(word));
  }

  static constexpr int kNumFrames = 6;
  input::TestFolder folder_;
};

TEST_F(BadInput, NoneAtAllIsFine) {
  const Outcome outcome = run_tum();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(std::filesystem::exists(out() / "report.html"));
  EXPECT_NE(outcome.out.find("6 of 6 (100.0 %)"), std::string::npos) << outcome.out;
}

TEST_F(BadInput, MissingFolder) {
  expect_clear_error(run("run " + quoted(folder_.root() / "nowhere") + " --out " + quoted(out())),
                     {"nowhere"});
  EXPECT_FALSE(std::filesystem::exists(out())) << "a bad source leaves no folder behind";
}

TEST_F(BadInput, EmptyFolder) {
  std::filesystem::create_directories(folder_.root() / "empty");
  expect_clear_error(run("run " + quoted(folder_.root() / "empty")), {"empty"});
  expect_clear_error(run("loops " + quoted(folder_.root() / "empty")), {"empty"});
}

TEST_F(BadInput, ImageCutInHalf) {
  const auto image = source() / "rgb/3.png";
  std::filesystem::resize_file(image, std::filesystem::file_size(image) / 2);
  expect_clear_error(run_tum(), {"rgb/3.png"});
  const std::string trajectory = core::read_file(out() / "trajectory.tum");
  EXPECT_EQ(std::count(trajectory.begin(), trajectory.end(), '\n'), 3)
      << "nothing is lost up to there: " << trajectory;
}

TEST_F(BadInput, ImageOfAnotherSizeInTheMiddle) {
  folder_.write_png("tum/rgb/3.png", wall()(cv::Rect(0, 0, 200, 100)).clone());
  expect_clear_error(run_tum(), {"rgb/3.png", "200 x 100", "320 x 240"});
}

TEST_F(BadInput, DepthOfAnotherSize) {
  folder_.write_png("tum/depth/2.png", cv::Mat(10, 10, CV_16U, cv::Scalar(1000)));
  expect_clear_error(run_tum(), {"depth/2.png"});
}

TEST_F(BadInput, MissingDepthImage) {
  std::filesystem::remove(source() / "depth/4.png");
  expect_warning(run_tum(), {"1 of 6 depth images are left out", "depth/4.png"});
}

TEST_F(BadInput, PoseFileWithNan) {
  folder_.write("tum/groundtruth.txt", "10.10 0 0 0 0 0 0 1\n10.11 nan 0 0 0 0 0 1\n");
  expect_warning(run_tum(), {"groundtruth.txt, line 2", "found 'nan'"});
}

TEST_F(BadInput, PoseFileWithAShortLine) {
  folder_.write("tum/groundtruth.txt", "10.10 0 0 0 0 0 0 1\n10.11 0 0 0\n");
  expect_warning(run_tum(), {"groundtruth.txt, line 2", "found 4 values"});
}

TEST_F(BadInput, TimestampsGoingBackwards) {
  folder_.write("tum/rgb.txt", "10.10 rgb/0.png\n10.12 rgb/1.png\n10.11 rgb/2.png\n");
  expect_clear_error(run_tum(), {"rgb.txt", "line 3"});
}

TEST_F(BadInput, WrongCalibration) {
  folder_.write("tum/camera.txt", "260 0 1600\n0 260 120\n0 0 1\n");
  expect_clear_error(run_tum(), {"camera.txt", "1600"});
  folder_.write("tum/camera.txt", "260 0 160\n0 260\n");
  expect_clear_error(run_tum(), {"camera.txt"});
}

TEST_F(BadInput, WithoutCalibrationTheFocalLengthIsGuessedAndSaid) {
  std::filesystem::remove(source() / "camera.txt");
  expect_warning(run_tum(), {"no calibration; focal length", "--camera FILE"});
}

TEST_F(BadInput, UnknownConfigKey) {
  expect_clear_error(run_tum("--set verify.min_inlier=3"), {"verify.min_inlier", "min_inliers"});
  folder_.write("mine.yaml", "seed: 1\nverify:\n  min_inlierz: 4\n");
  expect_clear_error(run_tum("--config " + quoted(folder_.root() / "mine.yaml")),
                     {"verify.min_inlierz", "mine.yaml", "line 3"});
}

TEST_F(BadInput, ValueOutOfRange) {
  expect_clear_error(run_tum("--set retrieve.min_similarity=7"),
                     {"retrieve.min_similarity = 7 is outside [-1, 1]"});
  expect_clear_error(run_tum("--set verify.min_inliers=many"), {"verify.min_inliers = many"});
  expect_clear_error(run_tum("--profile best"), {"best", "paper"});
}

TEST_F(BadInput, UnwritableOutputFolder) {
  folder_.write("a_file", "not a folder");
  expect_clear_error(
      run("run " + quoted(source()) + " --out " + quoted(folder_.root() / "a_file/out")),
      {"a_file/out"});
  // no user may make folders there, not even root
  expect_clear_error(run("run " + quoted(source()) + " --out /proc/nowhere"), {"/proc/nowhere"});
}

TEST_F(BadInput, FullDisk) {
  // as if the disk had room for 2 KiB files only
  const Outcome outcome =
      run_program("run " + quoted(source()) + " --out " + quoted(out()), folder_.root());
  EXPECT_EQ(outcome.exit_code, 0);
  std::filesystem::remove_all(out());
  const std::string limited = "trap '' XFSZ; ulimit -f 2; exec '" + std::string(SAMEWHERE_PROGRAM) +
                              "' run " + quoted(source()) + " --out " + quoted(out()) +
                              " >/dev/null 2>" + quoted(folder_.root() / "err.txt");
  const int status = std::system(("bash -c \"" + limited + "\"").c_str());
  expect_clear_error({WEXITSTATUS(status), "", core::read_file(folder_.root() / "err.txt")},
                     {"map.sw: cannot be"});
  for (const auto& entry : std::filesystem::directory_iterator(out())) {
    EXPECT_FALSE(entry.path().extension().string().starts_with(".partial"))
        << "no half-written file stays";
  }
}

TEST_F(BadInput, BlackAndTinyImagesAreNoErrorsButHaveNoPose) {
  for (int i = 0; i < kNumFrames; ++i) {
    folder_.write_png("tum/rgb/" + std::to_string(i) + ".png", cv::Mat::zeros(240, 320, CV_8U));
  }
  const Outcome black = run_tum();
  EXPECT_EQ(black.exit_code, 0) << black.err;
  EXPECT_NE(black.out.find("0 of 6 (0.0 %)"), std::string::npos) << black.out;
  for (int i = 0; i < 3; ++i)
    folder_.write_png("tiny/" + std::to_string(i) + ".png", wall()(cv::Rect(0, 0, 3, 2)).clone());
  const Outcome tiny = run("loops " + quoted(folder_.root() / "tiny") + " --out " +
                           quoted(folder_.root() / "tiny-out") + " --set retrieve.window_frames=0");
  EXPECT_EQ(tiny.exit_code, 0) << tiny.err;
}

TEST_F(BadInput, EvalOfWhatIsNoRun) {
  expect_clear_error(run("eval " + quoted(source())), {"config.yaml"});
  ASSERT_EQ(run_tum().exit_code, 0);
  core::write_file(out() / "loops.json", "{\"version\"");
  expect_clear_error(run("eval " + quoted(out())), {"loops.json"});
  expect_clear_error(run("eval --stages " + quoted(source())), {"timing.json"});
}

TEST_F(BadInput, UnknownCommandsAndOptions) {
  expect_clear_error(run("fly"), {"--help"});
  expect_clear_error(run(""), {"--help"});
  expect_clear_error(run("run"), {"SOURCE"});
  expect_clear_error(run_tum("--quick"), {"--quick"});
}

}  // namespace
}  // namespace samewhere::test
