#pragma once

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <samewhere/input/open.hpp>
#include <samewhere/input/test_folder.hpp>

namespace samewhere::input {

inline constexpr const char* kCamera = "30 0 15.5\n0 30 11.5\n0 0 1\n";

// Opens and reads the recording that a test writes into its folder. For tests only.
class Open : public testing::Test {
 protected:
  std::unique_ptr<core::Source> open() { return open_source(folder_.root(), config_); }

  std::vector<core::Frame> read_all() {
    const auto source = open();
    std::vector<core::Frame> frames;
    while (std::optional<core::Frame> frame = source->next()) frames.push_back(*frame);
    return frames;
  }

  std::string complaint_on_opening() {
    return complaint([this] { open(); });
  }
  std::string complaint_on_reading() {
    const auto source = open();
    return complaint([&] {
      while (source->next()) {
      }
    });
  }

  // What the log says while the recording is opened; "refused: ..." if it is.
  std::string said_on_opening() {
    testing::internal::CaptureStdout();
    const std::string error = complaint_on_opening();
    const std::string log = testing::internal::GetCapturedStdout();
    return error == "no error" ? log : "refused: " + error;
  }

  void write_image(const std::string& name, int width_px = 32) const {
    folder_.write_jpeg(name, picture(width_px, 24));
  }
  void write_depth(const std::string& name, int width_px = 32) const {
    folder_.write_png(name, cv::Mat(24, width_px, CV_16UC1, cv::Scalar(2500)));
  }

  TestFolder folder_;
  Config config_;
};

}  // namespace samewhere::input
