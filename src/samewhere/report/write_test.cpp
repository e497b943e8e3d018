#include <filesystem>
#include <set>

#include <gtest/gtest.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/report/html.hpp>
#include <samewhere/report/test_record.hpp>
#include <samewhere/report/write.hpp>

namespace samewhere::report {
namespace {

namespace fs = std::filesystem;

class Write : public testing::Test {
 protected:
  void SetUp() override {
    core::make_writable_folder(first_);
    core::make_writable_folder(second_);
  }
  void TearDown() override { fs::remove_all(root_); }

  static std::set<std::string> names_in(const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder))
      names.insert(entry.path().filename().string());
    return names;
  }

  const fs::path root_ =
      fs::temp_directory_path() / ("samewhere_report_" + std::to_string(getpid()));
  const fs::path first_ = root_ / "first";
  const fs::path second_ = root_ / "second";
};

TEST_F(Write, ARunLeavesAllItsFilesAndNothingElse) {
  write_run(sample_record(), first_);
  EXPECT_EQ(names_in(first_),
            (std::set<std::string>{"trajectory.tum", "odometry.tum", "frames.csv", "loops.json",
                                   "map.ply", "config.yaml", "timing.json", "report.html"}));
  EXPECT_EQ(core::read_tum(first_ / "trajectory.tum").size(), 312u);
  EXPECT_EQ(core::read_file(first_ / "config.yaml"), sample_record().config_yaml);
}

TEST_F(Write, TheSameRunTwiceGivesTheSameBytesButForItsDurations) {
  RunRecord slower = sample_record();
  slower.timings.add("track", 99.0);
  write_run(sample_record(), first_);
  write_run(slower, second_);
  for (const std::string& name : names_in(first_))
    EXPECT_EQ(core::read_file(first_ / name) == core::read_file(second_ / name),
              name != "timing.json" && name != "report.html")
        << name;
  EXPECT_EQ(without_durations(core::read_file(first_ / "report.html")),
            without_durations(core::read_file(second_ / "report.html")));
}

TEST_F(Write, AnEmptyRunHasItsFilesToo) {
  write_run({}, first_);
  EXPECT_EQ(names_in(first_).size(), 8u);
  EXPECT_EQ(core::read_file(first_ / "trajectory.tum"), "");
}

TEST_F(Write, RecognitionAloneLeavesMatchesAndAcceptedPairs) {
  RunRecord record = sample_record();
  record.frames.clear();
  const ScoredPair first{core::FrameId(305), core::FrameId(24), 0.9};
  const ScoredPair second{core::FrameId(306), core::FrameId(25), 0.9};
  write_recognition(record, {first}, {first, second}, first_);
  EXPECT_EQ(names_in(first_), (std::set<std::string>{"matches.txt", "accepted.txt", "loops.json",
                                                     "config.yaml", "timing.json", "report.html"}));
  EXPECT_EQ(core::read_file(first_ / "matches.txt"), "305 24 0.9\n");
  EXPECT_EQ(core::read_file(first_ / "accepted.txt"), "305 24 0.9\n306 25 0.9\n");
  EXPECT_NE(core::read_file(first_ / "report.html").find("\"frames\":{\"num\":0"),
            std::string::npos);
}

TEST_F(Write, WhatCannotBeWrittenIsNamedAndTheRestIsThere) {
  fs::create_directory(first_ / "trajectory.tum");
  fs::create_directory(first_ / "map.ply");
  const std::vector<std::string> errors = write_run(sample_record(), first_);
  ASSERT_EQ(errors.size(), 2u);
  EXPECT_NE(errors[0].find("trajectory.tum: cannot be written"), std::string::npos) << errors[0];
  EXPECT_NE(errors[1].find("map.ply: cannot be written"), std::string::npos) << errors[1];
  EXPECT_EQ(names_in(first_).size(), 8u) << "and no temporary file";
  EXPECT_FALSE(core::read_file(first_ / "loops.json").empty());
  EXPECT_EQ(write_run(sample_record(), root_ / "nowhere").size(), 8u);
}

}  // namespace
}  // namespace samewhere::report
