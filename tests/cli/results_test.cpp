// What a run does to files that are there, to a disk that is full, and to its output.

#include <algorithm>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "program.hpp"
#include "test_wall.hpp"
#include <samewhere/input/test_folder.hpp>

namespace samewhere::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// A small recording of a wall before which the camera does not move.
class Results : public testing::Test {
 protected:
  Results() {
    std::string rgb;
    std::string depth;
    for (int i = 0; i < 3; ++i) {
      rgb += fmt::format("10.{0} rgb/{0}.png\n", i);
      depth += fmt::format("10.{0} depth/{0}.png\n", i);
      folder_.write_png(fmt::format("rec/rgb/{}.png", i), wall());
      folder_.write_png(fmt::format("rec/depth/{}.png", i),
                        cv::Mat(240, 320, CV_16U, cv::Scalar(10000)));
    }
    folder_.write("rec/rgb.txt", rgb);
    folder_.write("rec/depth.txt", depth);
    folder_.write("rec/camera.txt", "260 0 160\n0 260 120\n0 0 1\n");
  }

  Outcome run(const std::string& arguments) const { return run_program(arguments, folder_.root()); }
  Outcome run_recording(const std::string& out, const std::string& more = "") const {
    return run(fmt::format("run {} --out {} {}", in("rec"), in(out), more));
  }
  // With `before` and `after` in a shell around the program.
  Outcome run_in_shell(const std::string& before, const std::string& arguments,
                       const std::string& after) const {
    folder_.write("script.sh",
                  fmt::format("{}\n'{}' {} {}\n", before, SAMEWHERE_PROGRAM, arguments, after));
    const int status = std::system(fmt::format("timeout 60 bash {} >{} 2>{} </dev/null",
                                               in("script.sh"), in("out.txt"), in("err.txt"))
                                       .c_str());
    return {WEXITSTATUS(status), core::read_file(folder_.at("out.txt")),
            core::read_file(folder_.at("err.txt"))};
  }
  std::string in(const std::string& name) const { return quoted(folder_.at(name)); }
  std::string text(const std::string& name) const { return core::read_file(folder_.at(name)); }

  input::TestFolder folder_;
};

TEST_F(Results, OfAnEarlierRunStayWithoutForce) {
  ASSERT_EQ(run_recording("out").exit_code, 0);
  const std::string before = text("out/timing.json");
  const Outcome refused = run_recording("out");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("out: holds the results of an earlier run"));
  EXPECT_EQ(text("out/timing.json"), before);
  const Outcome replaced = run_recording("out", "--force");
  EXPECT_EQ(replaced.exit_code, 0) << replaced.err;
  EXPECT_THAT(replaced.err, HasSubstr("out: removed 9 files of an earlier run"));
  EXPECT_NE(text("out/timing.json"), before);
}

TEST_F(Results, OfAnEarlierRunStayWhereTheFirstFrameIsBad) {
  ASSERT_EQ(run_recording("out").exit_code, 0);
  const std::string before = text("out/timing.json");
  folder_.cut("rec/depth/0.png", 0.5);
  for (const char* command : {"run", "loops"}) {
    const Outcome bad = run(fmt::format("{} {} --out {} --force", command, in("rec"), in("out")));
    EXPECT_EQ(bad.exit_code, 2);
    EXPECT_THAT(bad.err, HasSubstr("depth/0.png"));
    EXPECT_EQ(std::count(bad.err.begin(), bad.err.end(), '\n'), 1) << bad.err;
    EXPECT_EQ(run(fmt::format("{} {} --out {}", command, in("rec"), in("new"))).exit_code, 2);
  }
  EXPECT_EQ(text("out/timing.json"), before);
  EXPECT_TRUE(fs::exists(folder_.at("out/map.sw")));
  EXPECT_FALSE(fs::exists(folder_.at("new"))) << "nothing is made in vain";
}

TEST_F(Results, TwoRunsOfOneNameAtOnceGetTwoFolders) {
  const std::string one =
      fmt::format("'{}' run {} >/dev/null 2>&1 &\n", SAMEWHERE_PROGRAM, in("rec"));
  const Outcome last =
      run_in_shell(fmt::format("cd {}\n{}{}{}", quoted(folder_.root()), one, one, one),
                   "run " + in("rec"), "\ncode=$?; wait; exit $code");
  EXPECT_EQ(last.exit_code, 0) << last.err;
  for (const char* name : {"rec", "rec-2", "rec-3", "rec-4"})
    EXPECT_TRUE(fs::exists(folder_.at("runs") / name / "report.html")) << name;
}

TEST_F(Results, LinksAreReplacedAndNotFollowed) {
  folder_.write("mine", "old");
  fs::create_directories(folder_.at("out"));
  fs::create_symlink(folder_.at("mine"), folder_.at("out/.writable"));
  fs::create_symlink(folder_.at("mine"), folder_.at("out/trajectory.tum.partial"));
  ASSERT_EQ(run_recording("out").exit_code, 0);
  fs::create_symlink(folder_.at("mine"), folder_.at("graph.g2o"));
  EXPECT_EQ(run(fmt::format("map {} export --g2o {}", in("out/map.sw"), in("graph.g2o"))).exit_code,
            0);
  EXPECT_EQ(text("mine"), "old");
  EXPECT_TRUE(fs::is_symlink(folder_.at("out/.writable")));
  EXPECT_FALSE(fs::is_symlink(folder_.at("graph.g2o")));
}

TEST_F(Results, WhatFitsOnAFullDiskIsWrittenInOrderOfWorth) {
  // as if the disk had room for files of 2 KiB only
  const Outcome full = run_in_shell("trap '' XFSZ; ulimit -f 2",
                                    fmt::format("run {} --out {}", in("rec"), in("out")),
                                    "| cat; exit ${PIPESTATUS[0]}");
  EXPECT_EQ(full.exit_code, 2);
  EXPECT_THAT(full.out, HasSubstr("3 of 3 (100.0 %)"));
  EXPECT_THAT(full.err, HasSubstr("report.html: cannot be written: File too large"));
  const std::string trajectory = text("out/trajectory.tum");
  EXPECT_EQ(std::count(trajectory.begin(), trajectory.end(), '\n'), 3);
  EXPECT_THAT(text("out/frames.csv"), HasSubstr("rgb/2.png"));
  for (const auto& entry : fs::directory_iterator(folder_.at("out")))
    EXPECT_EQ(entry.path().string().find(".partial"), std::string::npos) << entry.path();
}

TEST_F(Results, OutputThatCannotBeWrittenIsExitCode2) {
  for (const char* command : {"config", "--help", "--version", "doctor --help", "twin --list"}) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    const Outcome full = run_in_shell("", command, ">/dev/full");
    EXPECT_EQ(full.exit_code, 2) << command;
    EXPECT_THAT(full.err, HasSubstr("standard output: cannot be written: No space left"))
        << command;
    const Outcome closed = run_in_shell("", command, ">&-");
    EXPECT_EQ(closed.exit_code, 2) << command;
    EXPECT_THAT(closed.err, HasSubstr("standard output: cannot be written")) << command;
    EXPECT_EQ(run_in_shell("", command, "2>&- >/dev/null").exit_code, 0) << command;
  }
}

TEST_F(Results, OutputThatIsClosedGoesIntoNoResult) {
  const Outcome closed =
      run_in_shell("", fmt::format("run {} --out {}", in("rec"), in("out")), ">&- 2>&- <&-");
  EXPECT_EQ(closed.exit_code, 2);
  EXPECT_EQ(run(fmt::format("map {} info", in("out/map.sw"))).exit_code, 0);
  EXPECT_TRUE(fs::exists(folder_.at("out/report.html")));
}

TEST_F(Results, AReaderThatGoesEndsNothingAndSaysNothing) {
  const Outcome cut =
      run_in_shell("", fmt::format("run {} --out {}", in("rec"), in("out")), "| head -c 1");
  EXPECT_EQ(cut.err, "");
  EXPECT_TRUE(fs::exists(folder_.at("out/timing.json")));
}

TEST_F(Results, AClosedTerminalFinishesTheFiles) {
  folder_.write("script.sh",
                fmt::format("set -m\n'{}' run 'twin:office-loop?seed=2' --set twin.num_frames=120 "
                            "--out {} >{} 2>&1 </dev/null &\n"
                            "until [ -e {} ]; do sleep 0.05; done\nkill -HUP $!; kill -HUP $!\n"
                            "wait $!\n",
                            SAMEWHERE_PROGRAM, in("out"), in("out.txt"), in("out/map.sw")));
  const int status = std::system(("timeout 240 bash " + in("script.sh")).c_str());
  EXPECT_EQ(WEXITSTATUS(status), 130) << text("out.txt");
  EXPECT_TRUE(fs::exists(folder_.at("out/report.html")));
}

TEST_F(Results, TextFromOutsideMovesNoCursor) {
  ASSERT_EQ(run_recording("out").exit_code, 0);
  folder_.write("out/loops.json",
                R"({"version": 1, "candidates": [{"candidate": 0, "query": 2, "match": 0, )"
                R"("verdict": "NOT", "stage": "similarity", )"
                R"("reason": "\u001b[2J\u009b31m\u202egone\nLOOP", "match_from_query": null, )"
                R"("scores": {"similarity": 0.9}}]})");
  for (const char* command : {"list", "show 0"}) {
    const Outcome listed = run(fmt::format("ledger {} {}", in("out"), command));
    EXPECT_EQ(listed.exit_code, 0) << listed.err;
    EXPECT_THAT(listed.out, HasSubstr("?[2J?31m?gone?LOOP")) << command;
  }
  folder_.write("rec/rgb.txt", "10.0 rgb/\x1b[2J" + std::string(1'000'000, 'x') + ".png\n");
  const Outcome refused = run_recording("new");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_LT(refused.err.size(), 3000U);
  EXPECT_EQ(refused.err.find('\x1b'), std::string::npos);
  folder_.write("rec/rgb.txt", "10.0 rgb/0" + std::string(1, '\0') + "x.png\n");
  EXPECT_THAT(run_recording("new").err, HasSubstr("rgb/0?x.png"));
}

}  // namespace
}  // namespace samewhere::test
