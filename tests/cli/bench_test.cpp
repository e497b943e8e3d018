// `samewhere bench paper` on a walk that comes back, and on what it cannot use.

#include <algorithm>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "program.hpp"
#include <samewhere/core/random.hpp>
#include <samewhere/input/test_folder.hpp>

namespace samewhere::test {
namespace {

class BenchPaper : public testing::Test {
 protected:
  // Two laps past three walls; the second has half of the light.
  BenchPaper() {
    for (int frame = 0; frame < 6; ++frame) {
      const std::string name = "walk/" + std::to_string(frame) + ".png";
      folder_.write_png(name, frame < 3 ? wall(frame) : cv::Mat(0.5 * wall(frame - 3)));
    }
    folder_.write("walk/same_place.txt",
                  "1 0 0 0 0 0\n0 1 0 0 0 0\n0 0 1 0 0 0\n1 0 0 1 0 0\n0 1 0 0 1 0\n0 0 1 0 0 1\n");
  }

  static cv::Mat wall(int number) {
    core::Random random(static_cast<std::uint64_t>(number));
    cv::Mat image(120, 160, CV_8U, cv::Scalar(128));
    for (int i = 0; i < 40; ++i) {
      const cv::Rect square(static_cast<int>(random.index(130)), static_cast<int>(random.index(90)),
                            24, 24);
      image(square).setTo(static_cast<double>(random.index(256)));
    }
    return image;
  }

  Outcome bench(const std::string& arguments) const {
    return run_program("bench paper " + arguments, folder_.root());
  }
  std::filesystem::path path(const std::string& name) const { return folder_.root() / name; }
  std::string walk() const { return quoted(path("walk")); }

  // One line that names `word`, exit code 2, no folder left behind.
  void expect_clear_error(const std::string& arguments, const std::string& word) const {
    const Outcome outcome = bench(arguments + " --out " + quoted(path("out")));
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_TRUE(outcome.err.starts_with("samewhere: ")) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(path("out")));
  }

  input::TestFolder folder_;
};

TEST_F(BenchPaper, PrintsAndWritesTheTables) {
  const Outcome outcome =
      bench(walk() + "@2 --tables 2-6 --methods paper,hog,ours --seeds 2 " +
            "--set describe.method=hog --blind-spot 100 --out " + quoted(path("out")));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* table : {"Table 2", "Table 3", "Table 4", "Table 5", "Table 6"})
    EXPECT_NE(outcome.out.find(table), std::string::npos) << table;
  const std::string tables = core::read_file(path("out/tables.txt"));
  EXPECT_TRUE(outcome.out.starts_with(tables)) << outcome.out;
  // the exact search finds each wall again
  const std::string rows = core::read_file(path("out/recognition.csv"));
  EXPECT_NE(rows.find("\nwalk,2,hog,exact,0,0,6,3,1.000000,"), std::string::npos) << rows;
  for (const char* file : {"paper.html", "results.json", "slam.csv", "blind-spot.csv",
                           "blind-spot.svg", "rows/walk-2.ours.json"})
    EXPECT_TRUE(std::filesystem::exists(path("out") / file)) << file;
  // the page says which command makes it again
  const std::string page = core::read_file(path("out/paper.html"));
  EXPECT_NE(page.find("@2&#39; --tables 2-6 --methods paper,hog,ours --seeds 2 --blind-spot 100 "
                      "--set describe.method=hog"),
            std::string::npos);
}

TEST_F(BenchPaper, RenderedImagesAreKeptWhereSaidAndElseUntilTheEnd) {
  const std::string run =
      "'twin:office-loop?seed=1@2' --tables 4 --methods hog --seeds 1 --set twin.num_frames=6 ";
  ASSERT_EQ(setenv("SAMEWHERE_CACHE", path("kept").c_str(), 1), 0);
  const Outcome named = bench(run + "--out " + quoted(path("named")));
  ASSERT_EQ(named.exit_code, 0) << named.err;
  EXPECT_FALSE(std::filesystem::is_empty(path("kept")));
  EXPECT_FALSE(std::filesystem::exists(path("named/.rendered-by-samewhere")));
  ASSERT_EQ(unsetenv("SAMEWHERE_CACHE"), 0);
  folder_.write("out/images/mine.txt", "another's\n");
  const Outcome unnamed = bench(run + "--out " + quoted(path("out")));
  ASSERT_EQ(unnamed.exit_code, 0) << unnamed.err;
  EXPECT_FALSE(std::filesystem::exists(path("out/.rendered-by-samewhere")));
  EXPECT_TRUE(std::filesystem::exists(path("out/images/mine.txt")));
  EXPECT_EQ(core::read_file(path("out/tables.txt")), core::read_file(path("named/tables.txt")));
}

TEST_F(BenchPaper, BadInputIsOneLineBeforeAnyWork) {
  expect_clear_error(walk() + " --tables 2,9", "9");
  expect_clear_error(walk() + " --tables 2 --methods hog,hog", "hog");
  expect_clear_error(walk() + " --tables 2 --methods " + quoted(path("nowhere.onnx")),
                     "nowhere.onnx");
  expect_clear_error(quoted(path("nowhere")), "nowhere");
  expect_clear_error(walk() + " --set retrieve.num_draws=0", "num_draws");
  expect_clear_error(walk() + " --blind-spot 3", "blind-spot");
  expect_clear_error(walk() + "@2 " + walk() + "@2", "two sequences are called walk-2");
  std::filesystem::remove(path("walk/same_place.txt"));
  expect_clear_error(walk() + "@2 --tables 2", "same_place.txt");
}

}  // namespace
}  // namespace samewhere::test
