// frames.csv, map.ply, timing.json, and the pictures of the page.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <turbojpeg.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/report/frames.hpp>
#include <samewhere/report/jpeg.hpp>
#include <samewhere/report/ply.hpp>
#include <samewhere/report/test_record.hpp>
#include <samewhere/report/timing_json.hpp>

namespace samewhere::report {
namespace {

TEST(MeasuredTrajectory, LeavesOutWhatWasNotMeasured) {
  const RunRecord record = sample_record();
  const core::Trajectory trajectory = measured_trajectory(record.frames);
  EXPECT_EQ(trajectory.size(), 312u);
  for (const core::StampedPose& pose : trajectory)
    EXPECT_FALSE(pose.stamp_s > 14.95 && pose.stamp_s < 15.75) << pose.stamp_s;
}

TEST(FramesCsv, HasALineForEveryFrame) {
  const std::string text = frames_csv(sample_record().frames);
  std::istringstream lines(text);
  int num_lines = 0;
  for (std::string line; std::getline(lines, line); ++num_lines)
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), 13) << line;
  EXPECT_EQ(num_lines, 321);
  EXPECT_NE(text.find("150,15.000000,corridor_150.png,lost,0,0,15,,,,,,,\n"), std::string::npos);
  EXPECT_NE(text.find("\n7,0.700000,corridor_7.png,tracking,1,120,0,"), std::string::npos);
}

TEST(FramesCsv, QuotesNamesThatNeedIt) {
  FrameRecord frame = frame_record(0, std::nullopt);
  frame.name = "a,\"b\".png";
  frame.pose.reference_keyframe = {};
  EXPECT_TRUE(
      frames_csv({frame}).ends_with("0,0.000000,\"a,\"\"b\"\".png\",initializing,0,0,,,,,,,,\n"));
}

TEST(FramesCsv, IsReadBackWhateverTheNames) {
  std::vector<FrameRecord> frames;
  for (std::uint64_t i = 0; i < 3; ++i) {
    frames.push_back(frame_record(static_cast<int>(i), core::Rigid3{}));
    frames.back().name = "a,\"relocalized,b\",\n.png";
  }
  frames[1].pose.status = core::FrameStatus::kResumed;
  const auto path =
      std::filesystem::temp_directory_path() / fmt::format("samewhere_{}_frames.csv", getpid());
  core::write_file(path, frames_csv(frames));
  const FrameTimes read = read_frames_csv(path);
  std::filesystem::remove(path);
  ASSERT_EQ(read.stamps_s.size(), 3U);
  EXPECT_EQ(read.stamps_s[2], frames[2].pose.stamp_s);
  EXPECT_EQ(read.relocalized, std::set{core::FrameId(1)});
}

TEST(FramesCsv, ALineThatIsNoneIsNamed) {
  const auto path =
      std::filesystem::temp_directory_path() / fmt::format("samewhere_{}_no_frames.csv", getpid());
  for (const char* line : {"0,1.0\n", "0,soon,a.png,relocalized,1,9,0,0,0,0,0,0,0,1\n"}) {
    core::write_file(path, std::string("index,stamp_s\n") + line);
    EXPECT_THAT([&] { read_frames_csv(path); },
                testing::ThrowsMessage<core::InputError>(testing::HasSubstr(
                    "_no_frames.csv, line 2: expected index,stamp_s,name,status")));
  }
  std::filesystem::remove(path);
}

TEST(Ply, HoldsTheBytesThatItsHeaderPromises) {
  const std::string bytes = ply_bytes(sample_record().points);
  const std::string end = "end_header\n";
  const std::size_t start = bytes.find(end) + end.size();
  EXPECT_TRUE(bytes.starts_with("ply\nformat binary_little_endian 1.0\nelement vertex 2\n"));
  ASSERT_EQ(bytes.size() - start, 2u * 15u);
  float y_m = 0.0f;
  std::memcpy(&y_m, bytes.data() + start + 4, sizeof y_m);
  EXPECT_EQ(y_m, 2.0f);
  EXPECT_EQ(static_cast<unsigned char>(bytes[start + 12]), 255);
  EXPECT_EQ(static_cast<unsigned char>(bytes[start + 13]), 128);
  EXPECT_EQ(static_cast<unsigned char>(bytes[start + 29]), 3);
}

TEST(Ply, LeavesOutPointsThatAreNowhere) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::string bytes = ply_bytes({{{nan, 0.0f, 0.0f}, {}}, {{1.0f, 2.0f, 3.0f}, {}}});
  EXPECT_NE(bytes.find("element vertex 1\n"), std::string::npos);
  EXPECT_TRUE(bytes.ends_with(std::string(3, '\0')));
  EXPECT_TRUE(
      ply_bytes({}).ends_with("element vertex 0\nproperty float x\nproperty float y\n"
                              "property float z\nproperty uchar red\nproperty uchar green\n"
                              "property uchar blue\nend_header\n"));
}

TEST(TimingJson, SumsUpEachStage) {
  const auto document = nlohmann::json::parse(timing_json(sample_record().timings, 123.5));
  EXPECT_EQ(document.at("frames_per_second"), 50.0);  // 2 frames in 40 ms
  EXPECT_EQ(document.at("peak_memory_mib"), 123.5);
  const auto& frame = document.at("stages").at("frame");
  EXPECT_EQ(frame.at("count"), 2);
  EXPECT_EQ(frame.at("total_ms"), 40.0);
  EXPECT_EQ(frame.at("median_ms"), 10.0);
  EXPECT_EQ(frame.at("p95_ms"), 30.0);
  EXPECT_EQ(frame.at("p99_ms"), 30.0);
  EXPECT_EQ(frame.at("processor_ms"), 24.0);
}

TEST(TimingJson, WithoutATimedFrameThereIsNoRate) {
  const auto document = nlohmann::json::parse(timing_json({}, 1.0));
  EXPECT_TRUE(document.at("frames_per_second").is_null());
  EXPECT_TRUE(document.at("stages").is_object());
  EXPECT_TRUE(document.at("stages").empty());
}

TEST(TimingJson, TellsWhereTheTimeWent) {
  core::Timings timings = sample_record().timings;
  timings.add("bundle", 50.0, 48.0);
  const Table table = stage_table(timing_json(timings, 1.0), "timing.json");
  ASSERT_GE(table.rows.size(), 2U);
  EXPECT_EQ(table.rows[0], (std::vector<std::string>{"bundle", "1", "50.00", "50.00", "50.00",
                                                     "24.00"}));  // 48 ms over two frames
  EXPECT_EQ(table.rows[1],
            (std::vector<std::string>{"frame", "2", "10.00", "30.00", "30.00", "12.00"}));
}

TEST(TimingJson, WhatIsNoneIsRefusedByName) {
  for (const std::string text : {"", "{", "{}", R"({"stages": {"frame": {"count": "two"}}})"}) {
    try {
      stage_table(text, "run/timing.json");
      FAIL() << text;
    } catch (const core::InputError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with("run/timing.json: not a timing.json"));
    }
  }
}

TEST(Base64, AgreesWithTheExamplesOfRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe"), "//4=");
}

std::pair<int, int> size_of_jpeg(const std::string& bytes) {
  const tjhandle reader = tjInitDecompress();
  int width_px = 0;
  int height_px = 0;
  int sampling = 0;
  int colours = 0;
  EXPECT_EQ(tjDecompressHeader3(reader, reinterpret_cast<const unsigned char*>(bytes.data()),
                                bytes.size(), &width_px, &height_px, &sampling, &colours),
            0);
  tjDestroy(reader);
  return {width_px, height_px};
}

TEST(Jpeg, ShrinksButNeverEnlarges) {
  const cv::Mat grey(50, 70, CV_8UC1, cv::Scalar(90));
  EXPECT_EQ(size_of_jpeg(jpeg_bytes(corridor_picture(1), 160)), std::pair(160, 120));
  EXPECT_EQ(size_of_jpeg(jpeg_bytes(grey, 160)), std::pair(70, 50));
  EXPECT_EQ(size_of_jpeg(jpeg_bytes(corridor_picture(1).colRange(10, 90), 160)),
            std::pair(80, 240));
}

TEST(Jpeg, RefusesWhatIsNoPicture) {
  EXPECT_THROW(jpeg_bytes({}, 160), core::ContractError);
  EXPECT_THROW(jpeg_bytes(cv::Mat(5, 5, CV_32FC1), 160), core::ContractError);
}

}  // namespace
}  // namespace samewhere::report
