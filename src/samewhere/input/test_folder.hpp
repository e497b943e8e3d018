#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <png.h>
#include <turbojpeg.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>

namespace samewhere::input {

// A temporary folder for one test, with small images made on the spot. For tests only.
class TestFolder {
 public:
  TestFolder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    root_ = std::filesystem::path(testing::TempDir()) /
            (std::string("samewhere_") + test->test_suite_name() + "_" + test->name() + "_" +
             std::to_string(getpid()));
    std::filesystem::create_directories(root_);
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;
  ~TestFolder() { std::filesystem::remove_all(root_); }

  const std::filesystem::path& root() const { return root_; }

  // The path of a file in it; folders on the way are made.
  std::filesystem::path at(const std::string& name) const {
    std::filesystem::create_directories((root_ / name).parent_path());
    return root_ / name;
  }

  void write(const std::string& name, const std::string& text) const {
    core::write_file(at(name), text);
  }

  void write_jpeg(const std::string& name, const cv::Mat& image) const {
    const std::unique_ptr<void, int (*)(tjhandle)> encoder(tjInitCompress(), &tjDestroy);
    const bool is_grey = image.channels() == 1;
    unsigned char* bytes = nullptr;
    unsigned long num_bytes = 0;  // NOLINT: the library's type
    ASSERT_EQ(tjCompress2(encoder.get(), image.data, image.cols, static_cast<int>(image.step),
                          image.rows, is_grey ? TJPF_GRAY : TJPF_BGR, &bytes, &num_bytes,
                          is_grey ? TJSAMP_GRAY : TJSAMP_420, 95, 0),
              0);
    write(name, std::string(reinterpret_cast<const char*>(bytes), num_bytes));
    tjFree(bytes);
  }

  // 8-bit grey, BGR or BGRA, or 16-bit grey.
  void write_png(const std::string& name, const cv::Mat& image) const {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = static_cast<png_uint_32>(image.cols);
    png.height = static_cast<png_uint_32>(image.rows);
    png.format = image.type() == CV_16UC1  ? PNG_FORMAT_LINEAR_Y
                 : image.type() == CV_8UC1 ? PNG_FORMAT_GRAY
                 : image.type() == CV_8UC3 ? PNG_FORMAT_BGR
                                           : PNG_FORMAT_BGRA;
    ASSERT_NE(png_image_write_to_file(&png, at(name).c_str(), 0, image.data, 0, nullptr), 0);
  }

  // Cuts a file to a share of its length.
  void cut(const std::string& name, double kept_ratio) const {
    const auto num_bytes = static_cast<double>(std::filesystem::file_size(at(name)));
    std::filesystem::resize_file(at(name), static_cast<std::uintmax_t>(kept_ratio * num_bytes));
  }

 private:
  std::filesystem::path root_;
};

// A smooth picture, so that JPEG keeps it nearly as it is; `phase` makes pictures differ.
inline cv::Mat picture(int width_px, int height_px, int phase = 0) {
  cv::Mat image(height_px, width_px, CV_8UC3);
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      image.at<cv::Vec3b>(y, x) = cv::Vec3b(static_cast<std::uint8_t>((2 * x + phase) % 200),
                                            static_cast<std::uint8_t>((3 * y + phase) % 200), 90);
    }
  }
  return image;
}

// The message of the InputError that `action` throws; "no error" if it throws none.
inline std::string complaint(const std::function<void()>& action) {
  try {
    action();
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace samewhere::input
