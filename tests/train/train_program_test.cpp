// `samewhere train` as a user runs it.

#include <algorithm>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "program.hpp"
#include <samewhere/core/random.hpp>
#include <samewhere/input/test_folder.hpp>

namespace samewhere::test {
namespace {

using testing::HasSubstr;

constexpr const char* kTiny =
    " --code-size 240 --channels 2 --batch 4 --threads 1 --epochs 5 --seed 3 ";

class TrainProgram : public testing::Test {
 protected:
  void write_photos(int num_photos) const {
    core::Random random(1);
    for (int i = 0; i < num_photos; ++i) {
      cv::Mat picture(60, 80, CV_8U, cv::Scalar(128));
      for (int k = 0; k < 10; ++k) {
        const cv::Rect square(static_cast<int>(random.index(70)),
                              static_cast<int>(random.index(50)), 10, 10);
        picture(square).setTo(static_cast<double>(random.index(256)));
      }
      folder_.write_png("photos/" + std::to_string(i) + ".png", picture);
    }
  }

  Outcome run(const std::string& arguments) const { return run_program(arguments, folder_.root()); }
  std::filesystem::path path(const std::string& name) const { return folder_.root() / name; }
  std::string to(const std::string& out) const {
    return "train --images " + quoted(path("photos")) + " --out " + quoted(path(out)) + kTiny;
  }
  // Lets the training run until its checkpoint holds two epochs, then sends the signal. Returns the
  // exit code: that of the program itself if it ends before.
  int stop_after_two(const std::string& out, const std::string& signal) const {
    const std::string checkpoint = quoted(path(out).replace_extension(".checkpoint"));
    // job control on: without it a shell's background process ignores SIGINT
    folder_.write("stop.sh", "set -m\n'" + std::string(SAMEWHERE_PROGRAM) + "' " + to(out) +
                                 " >/dev/null 2>&1 &\nwhile kill -0 $! && ! grep -aq '\\[2,' " +
                                 checkpoint + "; do sleep 0.01; done\nkill -" + signal +
                                 " $!\nwait $!\n");
    return WEXITSTATUS(std::system(("bash " + quoted(path("stop.sh")) + " 2>/dev/null").c_str()));
  }
  void expect_clear_error(const std::string& arguments,
                          const std::vector<std::string>& words) const {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    for (const auto& word : words) EXPECT_THAT(outcome.err, HasSubstr(word));
  }

  input::TestFolder folder_;
};

TEST_F(TrainProgram, StoppedByKillOrCtrlCGoesOnToTheSameBytes) {
  write_photos(160);  // a signal sent in the third epoch of five arrives long before the end
  const Outcome whole = run(to("whole.onnx"));
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  EXPECT_THAT(whole.out, HasSubstr("epoch 5/5"));
  EXPECT_TRUE(std::filesystem::exists(path("whole.json")));

  EXPECT_EQ(stop_after_two("killed.onnx", "KILL"), 128 + 9);
  EXPECT_FALSE(std::filesystem::exists(path("killed.onnx")));
  const Outcome resumed = run(to("killed.onnx"));
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_THAT(resumed.out, HasSubstr("resuming after epoch"));
  EXPECT_TRUE(core::read_file(path("killed.onnx")) == core::read_file(path("whole.onnx")));

  EXPECT_EQ(stop_after_two("stopped.onnx", "INT"), 130);
  EXPECT_EQ(run(to("stopped.onnx")).exit_code, 0);
  EXPECT_TRUE(core::read_file(path("stopped.onnx")) == core::read_file(path("whole.onnx")));
}

TEST_F(TrainProgram, BadInputEndsWithOneClearLine) {
  write_photos(2);
  std::filesystem::create_directories(path("empty"));
  expect_clear_error("train --images " + quoted(path("empty")) + " --out x.onnx", {"empty"});
  expect_clear_error("train --images " + quoted(path("none")) + " --out x.onnx", {"none"});
  expect_clear_error(to("x.network"), {"x.network", ".onnx"});
  folder_.write("file", "");
  expect_clear_error(to("file/x.onnx"), {"file"});
  expect_clear_error(to(std::string(300, 'a') + ".onnx"), {"aaa", "name too long"});
  folder_.write("there.onnx", "");
  expect_clear_error(to("there.onnx"), {"there.onnx", "free"});
  expect_clear_error(to("x.onnx") + "--input-size 100x100", {"100x100", "120x160"});
  expect_clear_error(to("x.onnx") + "--warp off", {"warp = off", "true, false", "(--warp off)"});
  expect_clear_error("train --out x.onnx", {"--images"});
  const std::string small = "train --images " + quoted(path("photos")) + " --out " +
                            quoted(path("x.onnx")) + " --epochs 1 --code-size ";
  expect_clear_error(small + "1000", {"code_size = 1000", "984 or 1008"});
  expect_clear_error(small + "many", {"code_size = many"});
  EXPECT_FALSE(std::filesystem::exists(path("x.onnx")));
}

// Where there are no such images, that is all that is wrong with them.
TEST_F(TrainProgram, EachExampleOfTheHelpIsACommand) {
  std::istringstream help(run("train --help").out);
  const std::string start = "  samewhere ";
  int num_examples = 0;
  for (std::string line; std::getline(help, line);) {
    if (line.rfind(start + "train --images", 0) != 0) continue;
    ++num_examples;
    SCOPED_TRACE(line);
    std::string arguments = line.substr(start.size());
    const auto at = [&](const std::string& option) {
      return arguments.find(option) + option.size();
    };
    const std::string images =
        arguments.substr(at("--images "), arguments.find(' ', at("--images ")) - at("--images "));
    arguments.insert(at("--out "), path("out").string() + "/");
    expect_clear_error(arguments, {images});
  }
  EXPECT_GE(num_examples, 3);
}

TEST_F(TrainProgram, HelpShowsExamples) {
  const Outcome help = run("train --help");
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.out, HasSubstr("Examples"));
  EXPECT_THAT(help.out, HasSubstr("--learning-rate"));
}

}  // namespace
}  // namespace samewhere::test
