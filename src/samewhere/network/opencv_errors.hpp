#pragma once

#include <exception>
#include <string>

#include <opencv2/core/utils/logger.hpp>

namespace samewhere::network {

// OpenCV writes to stderr what it also throws; while this lives it does not.
class QuietOpenCv {
 public:
  QuietOpenCv() : before_(cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT)) {}
  QuietOpenCv(const QuietOpenCv&) = delete;
  QuietOpenCv& operator=(const QuietOpenCv&) = delete;
  ~QuietOpenCv() { cv::utils::logging::setLogLevel(before_); }

 private:
  cv::utils::logging::LogLevel before_;
};

// What an exception of OpenCV says, on one line.
std::string reason_of(const std::exception& error);

}  // namespace samewhere::network
