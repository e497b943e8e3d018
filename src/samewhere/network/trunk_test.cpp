#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core/utility.hpp>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/network/test_onnx.hpp>
#include <samewhere/network/trunk.hpp>

namespace samewhere::network {
namespace {

using testing::HasSubstr;

constexpr int kRows = 12;
constexpr int kColumns = 16;
constexpr int kFilters = 4;

class TrunkFiles : public testing::Test {
 protected:
  TrunkFiles()
      : folder_(std::filesystem::temp_directory_path() /
                ("samewhere-trunks-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
    core::Random random(1);
    biases_ = test::random_weights(random, kFilters, 0.3);
    weights_ = test::random_weights(random, kFilters * 3 * 9, 0.3);
  }
  ~TrunkFiles() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }

  // One convolution of 3x3 and a rectifier with slope 0.1, in Darknet's two files.
  void write_darknet() const {
    write("small.cfg",
          "[net]\nwidth=16\nheight=12\nchannels=3\n\n[convolutional]\nfilters=4\nsize=3\nstride=1\n"
          "pad=1\nactivation=leaky\n");
    std::string bytes;
    const auto add = [&bytes](const auto& value) {
      const auto at = bytes.size();
      bytes.resize(at + sizeof(value));
      std::memcpy(bytes.data() + at, &value, sizeof(value));
    };
    for (const std::int32_t version : {0, 2, 5}) add(version);
    add(std::uint64_t{0});
    for (const float bias : biases_) add(bias);
    for (const float weight : weights_) add(weight);
    write("small.weights", bytes);
  }

  TrunkSpec darknet(const std::string& layer = "leaky_1") const {
    return {"small.cfg",
            layer,
            {.colour = Colour::kRgb,
             .size_px = {kColumns, kRows},
             .mean = {10.0, 20.0, 30.0},
             .scale = {0.01, 0.02, 0.03}}};
  }

  static cv::Mat noise() {
    core::Random random(7);
    cv::Mat image(kRows, kColumns, CV_8UC3);
    for (int i = 0; i < kRows * kColumns * 3; ++i)
      image.data[i] = static_cast<std::uint8_t>(random.index(256));
    return image;
  }

  std::filesystem::path folder_;
  std::vector<float> biases_;
  std::vector<float> weights_;
};

// Channel c of the input at a pixel, 0 outside, as picture_blob() promises it.
double input_at(const cv::Mat& bgr, int channel, int y, int x) {
  if (y < 0 || x < 0 || y >= kRows || x >= kColumns) return 0.0;
  return (bgr.at<cv::Vec3b>(y, x)[2 - channel] - 10.0 * (channel + 1)) * 0.01 * (channel + 1);
}

TEST_F(TrunkFiles, ADarknetLayerIsTheConvolutionThatItsFilesSay) {
  write_darknet();
  const cv::Mat image = noise();
  const cv::Mat map = make_trunk(folder_ / "small.cfg", darknet())->run(image);
  ASSERT_EQ(map.size[1], kFilters);
  for (int filter = 0; filter < kFilters; ++filter) {
    for (int y = 0; y < kRows; ++y) {
      for (int x = 0; x < kColumns; ++x) {
        double sum = biases_[static_cast<std::size_t>(filter)];
        for (int i = 0; i < 27; ++i) {
          sum += weights_[static_cast<std::size_t>(filter * 27 + i)] *
                 input_at(image, i / 9, y + i % 9 / 3 - 1, x + i % 3 - 1);
        }
        const int at[] = {0, filter, y, x};
        ASSERT_NEAR(map.at<float>(at), sum > 0.0 ? sum : 0.1 * sum, 1e-4);
      }
    }
  }
}

TEST_F(TrunkFiles, TheSameViewGivesTheSameMapWhateverTheThreadsDo) {
  write_darknet();
  const auto trunk = make_trunk(folder_ / "small.cfg", darknet());
  const cv::Mat first = trunk->run(noise());
  const int threads_before = cv::getNumThreads();
  for (const int num_threads : {1, 2, 5}) {
    cv::setNumThreads(num_threads);
    EXPECT_EQ(cv::norm(first.reshape(1, 1), trunk->run(noise()).reshape(1, 1), cv::NORM_INF), 0.0);
  }
  cv::setNumThreads(threads_before);
}

TEST_F(TrunkFiles, TheChecksumIsOfFilesLayerAndFormat) {
  write_darknet();
  const auto checksum = [this](const TrunkSpec& spec) {
    return make_trunk(folder_ / "small.cfg", spec)->checksum();
  };
  const std::uint64_t usual = checksum(darknet());
  EXPECT_EQ(checksum(darknet()), usual);
  EXPECT_NE(checksum(darknet("conv_0")), usual);
  TrunkSpec brighter = darknet();
  brighter.picture.mean[2] = 31.0;
  EXPECT_NE(checksum(brighter), usual);
  weights_.back() += 1.0F;
  write_darknet();
  EXPECT_NE(checksum(darknet()), usual);
}

TEST_F(TrunkFiles, WhatCannotBeReadIsNamed) {
  const auto complaint = [this](const std::string& file, const TrunkSpec& spec) -> std::string {
    try {
      make_trunk(folder_ / file, spec);
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "nothing";
  };
  write_darknet();
  EXPECT_THAT(complaint("small.cfg", darknet("nowhere")), HasSubstr("has no layer nowhere"));
  std::filesystem::remove(folder_ / "small.weights");
  EXPECT_THAT(complaint("small.cfg", darknet()), HasSubstr("small.weights"));
  write("broken.onnx", "no network");
  EXPECT_THAT(complaint("broken.onnx", darknet()), HasSubstr("OpenCV cannot read this network"));
  write("flat.onnx", test::onnx_file({.input = {1, 3, kRows, kColumns}}));
  EXPECT_THAT(complaint("flat.onnx", darknet("code")), HasSubstr("expected a feature map"));
  EXPECT_EQ(complaint("flat.onnx", darknet("Relu_features")), "nothing");
}

TEST(PictureBlob, AGreyViewFillsAllThreeChannels) {
  const cv::Mat blob = picture_blob(cv::Mat(4, 6, CV_8UC1, cv::Scalar(50)),
                                    {.colour = Colour::kBgr, .size_px = {3, 2}});
  EXPECT_EQ(blob.size[1], 3);
  EXPECT_EQ(cv::norm(blob.reshape(1, 1), cv::Mat(1, 18, CV_32FC1, cv::Scalar(50)), cv::NORM_INF),
            0.0);
  EXPECT_THROW(picture_blob(cv::Mat(), {.size_px = {3, 2}}), core::ContractError);
}

}  // namespace
}  // namespace samewhere::network
