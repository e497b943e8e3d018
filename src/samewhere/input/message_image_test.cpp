#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/input/message_image.hpp>
#include <samewhere/input/test_folder.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using ::testing::HasSubstr;

messages::Image message_of(const std::string& encoding, std::uint32_t width, std::uint32_t height,
                           std::vector<std::uint8_t> data) {
  messages::Image image;
  image.encoding = encoding;
  image.width = width;
  image.height = height;
  image.step = static_cast<std::uint32_t>(data.size()) / height;
  image.data = std::move(data);
  return image;
}

TEST(MessageImage, EveryColourEncodingShowsTheSameRed) {
  const cv::Vec3b red(0, 0, 255);
  EXPECT_EQ(image_of(message_of("bgr8", 1, 1, {0, 0, 255}), "a").at<cv::Vec3b>(0, 0), red);
  EXPECT_EQ(image_of(message_of("rgb8", 1, 1, {255, 0, 0}), "a").at<cv::Vec3b>(0, 0), red);
  EXPECT_EQ(image_of(message_of("bgra8", 1, 1, {0, 0, 255, 9}), "a").at<cv::Vec3b>(0, 0), red);
  EXPECT_EQ(image_of(message_of("rgba8", 1, 1, {255, 0, 0, 9}), "a").at<cv::Vec3b>(0, 0), red);
  EXPECT_EQ(image_of(message_of("rgb16", 1, 1, {255, 255, 0, 0, 0, 0}), "a").at<cv::Vec3b>(0, 0),
            red);
}

// Red in the first place of the pattern alone; in the middle of the picture OpenCV makes it red.
TEST(MessageImage, BayerPatternsAreNamedByTheirFirstRow) {
  const auto pattern = [](int red_x, int red_y) {
    std::vector<std::uint8_t> data(8 * 8, 0);
    for (int y = red_y; y < 8; y += 2)
      for (int x = red_x; x < 8; x += 2) data[static_cast<std::size_t>(8 * y + x)] = 200;
    return data;
  };
  const std::pair<const char*, std::vector<std::uint8_t>> all[] = {{"bayer_rggb8", pattern(0, 0)},
                                                                   {"bayer_grbg8", pattern(1, 0)},
                                                                   {"bayer_gbrg8", pattern(0, 1)},
                                                                   {"bayer_bggr8", pattern(1, 1)}};
  for (const auto& [encoding, data] : all) {
    const cv::Vec3b middle = image_of(message_of(encoding, 8, 8, data), "a").at<cv::Vec3b>(4, 4);
    EXPECT_GT(middle[2], 90) << encoding;
    EXPECT_EQ(middle[0], 0) << encoding;
  }
}

TEST(MessageImage, GreyStaysGrey) {
  const cv::Mat grey = image_of(message_of("mono8", 2, 1, {7, 8}), "a");
  EXPECT_EQ(grey.type(), CV_8UC1);
  EXPECT_EQ(grey.at<std::uint8_t>(0, 1), 8);
  EXPECT_EQ(image_of(message_of("mono16", 1, 1, {0, 128}), "a").at<std::uint8_t>(0, 0), 128);
  messages::Image big = message_of("mono16", 1, 1, {128, 0});
  big.is_bigendian = 1;
  EXPECT_EQ(image_of(big, "a").at<std::uint8_t>(0, 0), 128);
}

TEST(MessageImage, YuvBecomesColour) {
  // a grey of 128: both chroma values are 128
  for (const char* encoding : {"yuv422", "yuv422_yuy2"}) {
    const bool is_luma_second = std::string(encoding) == "yuv422";
    const std::uint8_t luma = 200;
    const std::vector<std::uint8_t> data =
        is_luma_second ? std::vector<std::uint8_t>{128, luma, 128, luma, 128, luma, 128, luma}
                       : std::vector<std::uint8_t>{luma, 128, luma, 128, luma, 128, luma, 128};
    const cv::Vec3b pixel = image_of(message_of(encoding, 2, 2, data), "a").at<cv::Vec3b>(0, 0);
    EXPECT_EQ(pixel[0], pixel[1]) << encoding;
    EXPECT_GT(pixel[0], 190) << encoding;
  }
}

TEST(MessageImage, RowsMayHavePadding) {
  messages::Image padded = message_of("mono8", 2, 2, {1, 2, 99, 3, 4, 99});
  padded.step = 3;
  EXPECT_EQ(image_of(padded, "a").at<std::uint8_t>(1, 0), 3);
}

TEST(MessageImage, WhatDoesNotFitIsRefusedInOneLine) {
  const auto message = [](const messages::Image& image) {
    try {
      image_of(image, "/camera 12.5");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(message(message_of("jpeg2000", 1, 1, {1})),
              HasSubstr("/camera 12.5: has the encoding 'jpeg2000'"));
  EXPECT_THAT(message(message_of("bgr8", 2, 1, {1, 2, 3})),
              HasSubstr("expected 1 rows of at least 6"));
  EXPECT_THAT(message(message_of("mono8", 4'000'000'000U, 1, {1})), HasSubstr("pixels"));
  EXPECT_THAT(message(message_of("bayer_rggb8", 1, 1, {1})), HasSubstr("even"));
  messages::Image empty = message_of("mono8", 1, 1, {});
  EXPECT_NE(message(empty), "");
}

TEST(MessageDepth, IsInMetres) {
  const cv::Mat millimetres = depth_of(message_of("16UC1", 2, 1, {0xe8, 0x03, 0, 0}), "a", 1000.0);
  EXPECT_EQ(millimetres.at<float>(0, 0), 1.0F);
  EXPECT_EQ(millimetres.at<float>(0, 1), 0.0F);
  std::vector<std::uint8_t> data(8);
  const float values[] = {2.5F, std::numeric_limits<float>::quiet_NaN()};
  std::memcpy(data.data(), values, 8);
  const cv::Mat metres = depth_of(message_of("32FC1", 2, 1, data), "a", 1000.0);
  EXPECT_EQ(metres.at<float>(0, 0), 2.5F);
  EXPECT_EQ(metres.at<float>(0, 1), 0.0F);
  EXPECT_THROW(depth_of(message_of("bgr8", 1, 1, {1, 2, 3}), "a", 1000.0), InputError);
}

messages::CompressedImage compressed(const std::string& format, const cv::Mat& image,
                                     const std::string& ending = ".png") {
  messages::CompressedImage message;
  message.format = format;
  EXPECT_TRUE(cv::imencode(ending, image, message.data));
  return message;
}

TEST(CompressedImage, OfPngHasThePixelsThatWereSent) {
  const cv::Mat colour = picture(6, 4);
  EXPECT_EQ(cv::norm(image_of(compressed("bgr8; png compressed bgr8", colour), "a"), colour,
                     cv::NORM_INF),
            0.0);
  const cv::Mat grey = (cv::Mat_<std::uint8_t>(1, 3) << 0, 7, 255);
  const cv::Mat back = image_of(compressed("mono8; png compressed ", grey), "a");
  ASSERT_EQ(back.type(), CV_8UC1);
  EXPECT_EQ(cv::norm(back, grey, cv::NORM_INF), 0.0);
}

TEST(CompressedImage, Of16BitsIsScaledTo8AsAnImageIs) {
  const cv::Mat grey = (cv::Mat_<std::uint16_t>(1, 3) << 0, 128 * 257, 65535);
  const cv::Mat back = image_of(compressed("mono16; png compressed ", grey), "a");
  ASSERT_EQ(back.type(), CV_8UC1);
  EXPECT_EQ(back.at<std::uint8_t>(0, 0), 0);
  EXPECT_EQ(back.at<std::uint8_t>(0, 1), 128);
  EXPECT_EQ(back.at<std::uint8_t>(0, 2), 255);
}

TEST(CompressedImage, OfJpegHasNearlyThosePixels) {
  const cv::Mat colour = picture(64, 48);
  const cv::Mat back = image_of(compressed("rgb8; jpeg compressed bgr8", colour, ".jpg"), "a");
  ASSERT_EQ(back.type(), CV_8UC3);
  ASSERT_EQ(back.size(), colour.size());
  EXPECT_LT(cv::norm(back, colour, cv::NORM_L1) / (64.0 * 48.0 * 3.0), 6.0);
}

TEST(CompressedImage, ThatIsCutIsRefusedByItsName) {
  messages::CompressedImage cut = compressed("bgr8; png compressed bgr8", picture(64, 48));
  cut.data.resize(cut.data.size() / 2);
  EXPECT_THAT(complaint([&] { image_of(cut, "/camera 12.5"); }), HasSubstr("/camera 12.5"));
  cut.data.clear();
  EXPECT_THAT(complaint([&] { image_of(cut, "/camera 12.5"); }), HasSubstr("/camera 12.5"));
}

// What compressed_depth_image_transport writes: an enumerator that is 0, two numbers of the
// quantization, and a PNG of 16 bits.
messages::CompressedImage compressed_depth(const std::string& format, float scale, float offset,
                                           const cv::Mat& stored) {
  messages::CompressedImage message = compressed(format, stored);
  const std::int32_t inverse_depth = 0;
  std::vector<std::uint8_t> header(12);
  std::memcpy(header.data(), &inverse_depth, 4);
  std::memcpy(header.data() + 4, &scale, 4);
  std::memcpy(header.data() + 8, &offset, 4);
  message.data.insert(message.data.begin(), header.begin(), header.end());
  return message;
}

// Its quantization of metres, with its own defaults. Rounded as cv::Mat_<ushort> is by a cast.
constexpr float kQuantization = 100.0F;
constexpr float kMaxDepth_m = 10.0F;
constexpr float kScale = kQuantization * (kQuantization + 1.0F);
constexpr float kOffset = 1.0F - kScale / kMaxDepth_m;

cv::Mat quantized(const std::vector<float>& depths_m) {
  cv::Mat stored(1, static_cast<int>(depths_m.size()), CV_16UC1);
  for (int x = 0; x < stored.cols; ++x) {
    const float depth_m = depths_m[static_cast<std::size_t>(x)];
    stored.at<std::uint16_t>(0, x) =
        depth_m < kMaxDepth_m ? static_cast<std::uint16_t>(kScale / depth_m + kOffset) : 0;
  }
  return stored;
}

TEST(CompressedDepth, Of16BitsIsInUnits) {
  const cv::Mat stored = (cv::Mat_<std::uint16_t>(1, 3) << 0, 1500, 60000);
  // the two numbers are not set for these
  for (const float unset : {0.0F, 1e30F, std::numeric_limits<float>::quiet_NaN()}) {
    for (const char* format : {"16UC1; compressedDepth", "16UC1; compressedDepth png"}) {
      const messages::CompressedImage message = compressed_depth(format, unset, unset, stored);
      EXPECT_TRUE(is_depth_format(message.format));
      const cv::Mat depth_m = depth_of(message, "a", 1000.0);
      EXPECT_EQ(depth_m.type(), CV_32FC1);
      EXPECT_EQ(depth_m.at<float>(0, 0), 0.0F);
      EXPECT_EQ(depth_m.at<float>(0, 1), 1.5F);
      EXPECT_EQ(depth_m.at<float>(0, 2), 60.0F);
      EXPECT_EQ(depth_of(message, "a", 500.0).at<float>(0, 1), 3.0F);
    }
  }
}

TEST(CompressedDepth, OfFloatsComesBackAsFarAsItsQuantizationGoes) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> depths_m = {0.4F, 1.0F, 2.5F, 7.3F, 9.9F, none, 12.0F};
  const cv::Mat depth_m =
      depth_of(compressed_depth("32FC1; compressedDepth", kScale, kOffset, quantized(depths_m)),
               "a", 1000.0);
  ASSERT_EQ(depth_m.cols, 7);
  for (int x = 0; x < 5; ++x) {
    const float sent_m = depths_m[static_cast<std::size_t>(x)];
    EXPECT_NEAR(depth_m.at<float>(0, x), sent_m, 1.01F * sent_m * sent_m / kScale + 1e-5F);
  }
  EXPECT_EQ(depth_m.at<float>(0, 5), 0.0F) << "unknown";
  EXPECT_EQ(depth_m.at<float>(0, 6), 0.0F) << "beyond what is sent";
}

TEST(CompressedDepth, OfAPngAloneIsInUnits) {
  const cv::Mat stored = (cv::Mat_<std::uint16_t>(1, 2) << 0, 1500);
  EXPECT_EQ(depth_of(compressed("16UC1; png compressed ", stored), "a", 1000.0).at<float>(0, 1),
            1.5F);
}

TEST(CompressedDepth, ThatIsNoPngOf16BitsIsRefusedByItsName) {
  const cv::Mat stored(4, 4, CV_16UC1, cv::Scalar(1000));
  const auto refusal = [](const messages::CompressedImage& message) {
    return complaint([&] { depth_of(message, "/depth 12.5", 1000.0); });
  };
  messages::CompressedImage message = compressed_depth("16UC1; compressedDepth", 0, 0, stored);
  message.data.resize(12);
  EXPECT_THAT(refusal(message), HasSubstr("/depth 12.5"));
  message.data.clear();
  EXPECT_THAT(refusal(message), HasSubstr("/depth 12.5"));
  // run lengths in place of the PNG
  message = compressed_depth("16UC1; compressedDepth rvl", 0, 0, stored);
  message.data.resize(40, 1);
  std::fill(message.data.begin() + 12, message.data.end(), std::uint8_t{1});
  EXPECT_THAT(refusal(message), HasSubstr("/depth 12.5"));
  EXPECT_THAT(refusal(compressed("bgr8; png compressed bgr8", picture(4, 4))),
              HasSubstr("/depth 12.5"));
}

messages::CameraInfo camera_info(const std::string& model, std::vector<double> d) {
  messages::CameraInfo info;
  info.width = 640;
  info.height = 480;
  info.distortion_model = model;
  info.d = std::move(d);
  info.k = {500, 0, 319.5, 0, 510, 239.5, 0, 0, 1};
  info.p = {400, 0, 300, 0, 0, 400, 200, 0, 0, 0, 1, 0};
  return info;
}

TEST(MessageCamera, HasTheModelsOfRos) {
  const auto plumb_bob = std::get<core::PinholeRadtan>(
      *camera_of(camera_info("plumb_bob", {0.1, -0.2, 0.01, 0.02, 0.3}), false, "a"));
  EXPECT_EQ(plumb_bob.fx_px, 500.0);
  EXPECT_EQ(plumb_bob.fy_px, 510.0);
  EXPECT_EQ(plumb_bob.k3, 0.3);
  EXPECT_EQ(plumb_bob.p1, 0.01);
  const auto rational = std::get<core::PinholeRadtan>(
      *camera_of(camera_info("rational_polynomial", {0.1, 0, 0, 0, 0, 0.05, 0, 0}), false, "a"));
  EXPECT_EQ(rational.k4, 0.05);
  const auto fisheye = std::get<core::KannalaBrandt>(
      *camera_of(camera_info("equidistant", {0.01, 0.02, 0.0, 0.0}), false, "a"));
  EXPECT_EQ(fisheye.k2, 0.02);
  const auto rectified = std::get<core::PinholeRadtan>(
      *camera_of(camera_info("plumb_bob", {0.1, -0.2, 0.01, 0.02, 0.3}), true, "a"));
  EXPECT_EQ(rectified.fx_px, 400.0);
  EXPECT_EQ(rectified.k1, 0.0);
}

TEST(MessageCamera, KnowsNoneAndRefusesOthers) {
  messages::CameraInfo none = camera_info("", {});
  none.k = {};
  EXPECT_FALSE(camera_of(none, false, "a"));
  EXPECT_TRUE(camera_of(camera_info("", {}), false, "a"));
  EXPECT_THROW(camera_of(camera_info("omni", {1.0}), false, "a"), InputError);
  EXPECT_THROW(camera_of(camera_info("plumb_bob", {1e9}), false, "a"), InputError);
}

TEST(MessageCamera, OfTooManyPixelsIsRefused) {
  for (const std::uint32_t side_px : {100'001U, 0x7fff'ffffU, 0x8000'0000U, 0xffff'ffffU}) {
    messages::CameraInfo info = camera_info("plumb_bob", {});
    info.width = side_px;
    EXPECT_THAT(complaint([&info] { camera_of(info, false, "a"); }), HasSubstr("pictures of"));
    EXPECT_THAT(complaint([&info] { camera_of(info, true, "a"); }), HasSubstr("pictures of"));
  }
}

// A picture of which each pixel is the mean of two by two: its centres lie half a pixel aside.
TEST(MessageCamera, OfACroppedAndBinnedPictureHasItsPixels) {
  messages::CameraInfo info = camera_info("plumb_bob", {});
  info.binning_x = info.binning_y = 2;
  info.roi = {.x_offset = 40, .y_offset = 20, .height = 400, .width = 560};
  const auto camera = std::get<core::PinholeRadtan>(*camera_of(info, false, "a"));
  EXPECT_EQ(camera.width_px, 280);
  EXPECT_EQ(camera.height_px, 200);
  EXPECT_EQ(camera.fx_px, 250.0);
  EXPECT_EQ(camera.cx_px, (319.5 - 40.0 - 0.5) / 2.0);
}

TEST(MessageImage, DepthOfMinusZeroIsUnknown) {
  messages::Image message{.height = 1, .width = 2, .encoding = "32FC1", .step = 8};
  message.data = {0, 0, 0, 0x80, 0, 0, 0x80, 0x3f};  // -0, 1
  const cv::Mat depth_m = depth_of(message, "depth", 1000.0);
  EXPECT_FALSE(std::signbit(depth_m.at<float>(0, 0)));
  EXPECT_EQ(depth_m.at<float>(0, 0), 0.0F);
  EXPECT_EQ(depth_m.at<float>(0, 1), 1.0F);
}

}  // namespace
}  // namespace samewhere::input
