#include <array>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include <samewhere/core/random.hpp>
#include <samewhere/input/exif.hpp>
#include <samewhere/input/image_file.hpp>
#include <samewhere/input/test_folder.hpp>

namespace samewhere::input {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class ImageFile : public testing::Test {
 protected:
  std::string complaint_about(const std::string& name) {
    return complaint([&] { read_image(folder_.at(name)); });
  }
  std::string complaint_about_depth(const std::string& name) {
    return complaint([&] { read_depth(folder_.at(name), 1000.0); });
  }

  TestFolder folder_;
};

double largest_difference(const cv::Mat& a, const cv::Mat& b) {
  return cv::norm(a, b, cv::NORM_INF);
}

cv::Mat noise(int type, std::uint64_t seed) {
  core::Random random(seed);
  cv::Mat image(13, 17, type);
  for (int y = 0; y < image.rows; ++y) {
    for (std::size_t i = 0; i < image.cols * image.elemSize(); ++i) {
      image.ptr(y)[i] = static_cast<std::uint8_t>(random.index(256));
    }
  }
  return image;
}

TEST_F(ImageFile, APngComesBackAsItWasWritten) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    for (const int type : {CV_8UC1, CV_8UC3}) {
      const cv::Mat image = noise(type, seed);
      folder_.write_png("a.png", image);
      const cv::Mat back = read_image(folder_.at("a.png"));
      ASSERT_EQ(back.type(), type);
      EXPECT_EQ(largest_difference(back, image), 0.0);
    }
  }
}

TEST_F(ImageFile, AnAlphaChannelIsDropped) {
  const cv::Mat image = noise(CV_8UC4, 1);
  folder_.write_png("a.png", image);
  const cv::Mat back = read_image(folder_.at("a.png"));
  ASSERT_EQ(back.type(), CV_8UC3);
  EXPECT_EQ(back.at<cv::Vec3b>(5, 7)[0], image.at<cv::Vec4b>(5, 7)[0]);
  EXPECT_EQ(back.at<cv::Vec3b>(5, 7)[2], image.at<cv::Vec4b>(5, 7)[2]);
}

TEST_F(ImageFile, APaletteBecomesColours) {
  const std::array<std::uint8_t, 4> indices = {0, 1, 1, 0};
  const std::array<std::uint8_t, 6> blue_green_red = {10, 20, 30, 200, 100, 50};
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = 2;
  png.height = 2;
  png.format = PNG_FORMAT_BGR_COLORMAP;
  png.colormap_entries = 2;
  ASSERT_NE(png_image_write_to_file(&png, folder_.at("a.png").c_str(), 0, indices.data(), 0,
                                    blue_green_red.data()),
            0);
  const cv::Mat image = read_image(folder_.at("a.png"));
  ASSERT_EQ(image.type(), CV_8UC3);
  EXPECT_EQ(image.at<cv::Vec3b>(0, 0), cv::Vec3b(10, 20, 30));
  EXPECT_EQ(image.at<cv::Vec3b>(0, 1), cv::Vec3b(200, 100, 50));
}

TEST_F(ImageFile, AJpegComesBackInBlueGreenRed) {
  const cv::Mat image = picture(64, 48);
  folder_.write_jpeg("a.jpg", image);
  const cv::Mat back = read_image(folder_.at("a.jpg"));
  ASSERT_EQ(back.type(), CV_8UC3);
  ASSERT_EQ(back.size(), image.size());
  EXPECT_LT(cv::norm(back, image, cv::NORM_L1) / (64.0 * 48.0 * 3.0), 3.0);
}

TEST_F(ImageFile, AGreyJpegStaysGrey) {
  const cv::Mat image(24, 32, CV_8UC1, cv::Scalar(77));
  folder_.write_jpeg("a.jpg", image);
  const cv::Mat back = read_image(folder_.at("a.jpg"));
  ASSERT_EQ(back.type(), CV_8UC1);
  EXPECT_LE(largest_difference(back, image), 1.0);
}

TEST_F(ImageFile, TheContentTellsTheFormatNotTheName) {
  folder_.write_png("a.jpg", picture(8, 8));
  EXPECT_EQ(largest_difference(read_image(folder_.at("a.jpg")), picture(8, 8)), 0.0);
}

TEST_F(ImageFile, AFileCutShortIsNamedWhereverItIsCut) {
  for (const double kept_ratio : {0.02, 0.3, 0.5, 0.9, 0.999}) {
    SCOPED_TRACE(kept_ratio);
    folder_.write_jpeg("cut.jpg", picture(128, 96));
    folder_.cut("cut.jpg", kept_ratio);
    EXPECT_THAT(complaint_about("cut.jpg"), AllOf(HasSubstr("cut.jpg"), HasSubstr("damaged")));
    folder_.write_png("cut.png", noise(CV_8UC3, 3));
    folder_.cut("cut.png", kept_ratio);
    EXPECT_THAT(complaint_about("cut.png"), AllOf(HasSubstr("cut.png"), HasSubstr("damaged PNG")));
  }
}

TEST_F(ImageFile, AChangedByteInAPngIsFound) {
  folder_.write_png("a.png", noise(CV_8UC3, 4));
  std::string bytes = core::read_file(folder_.at("a.png"));
  bytes[bytes.size() / 2] ^= 1;
  folder_.write("a.png", bytes);
  EXPECT_THAT(complaint_about("a.png"), HasSubstr("damaged PNG"));
}

TEST_F(ImageFile, StrayBytesBeforeAMarkerDoNoHarm) {
  folder_.write_jpeg("a.jpg", picture(64, 48));
  const cv::Mat image = read_image(folder_.at("a.jpg"));
  std::string bytes = core::read_file(folder_.at("a.jpg"));
  bytes.insert(bytes.size() - 2, std::string("\0\0\0", 3));
  folder_.write("a.jpg", bytes);
  EXPECT_EQ(largest_difference(read_image(folder_.at("a.jpg")), image), 0.0);
}

TEST_F(ImageFile, RandomDamageEndsInAnErrorOrAnImageNeverInACrash) {
  folder_.write_jpeg("good.jpg", picture(32, 24));
  folder_.write_png("good.png", picture(32, 24));
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    core::Random random(seed);
    std::string bytes = core::read_file(folder_.at(seed % 2 == 0 ? "good.jpg" : "good.png"));
    for (int i = 0; i < 3; ++i)
      bytes[random.index(bytes.size())] = static_cast<char>(random.next());
    folder_.write("bad", bytes);
    complaint_about("bad");
    complaint_about_depth("bad");
  }
}

TEST_F(ImageFile, OtherFormatsAreRefusedByName) {
  folder_.write("a.jpg", "GIF89a...");
  EXPECT_THAT(complaint_about("a.jpg"),
              AllOf(HasSubstr("a.jpg"), HasSubstr("neither JPEG nor PNG")));
  folder_.write("b.png", "");
  EXPECT_THAT(complaint_about("b.png"), AllOf(HasSubstr("b.png"), HasSubstr("is empty")));
  EXPECT_THAT(complaint_about("c.png"), AllOf(HasSubstr("c.png"), HasSubstr("cannot be read")));
}

TEST_F(ImageFile, SixteenBitsAreScaledToEight) {
  for (const char* name : {"a.png", "a.tif", "a.pgm"}) {
    ASSERT_TRUE(cv::imwrite(folder_.at(name), cv::Mat(4, 5, CV_16UC1, cv::Scalar(200 * 257))));
    const cv::Mat grey = read_image(folder_.at(name));
    ASSERT_EQ(grey.type(), CV_8UC1) << name;
    EXPECT_EQ(grey.at<std::uint8_t>(2, 2), 200) << name;
  }
  ASSERT_TRUE(
      cv::imwrite(folder_.at("c.png"), cv::Mat(4, 5, CV_16UC3, cv::Scalar(2570, 5140, 65535))));
  EXPECT_EQ(read_image(folder_.at("c.png")).at<cv::Vec3b>(1, 1), cv::Vec3b(10, 20, 255));
}

TEST_F(ImageFile, OtherFormatsComeBackAsTheyWereWritten) {
  const cv::Mat colour = noise(CV_8UC3, 5);
  const cv::Mat grey = noise(CV_8UC1, 6);
  for (const char* name : {"a.bmp", "a.ppm", "a.pnm", "a.tif", "a.webp"}) {
    const bool is_lossy = std::string(name) == "a.webp";
    ASSERT_TRUE(cv::imwrite(
        folder_.at(name), colour,
        is_lossy ? std::vector<int>{cv::IMWRITE_WEBP_QUALITY, 101} : std::vector<int>{}))
        << name;
    EXPECT_EQ(largest_difference(read_image(folder_.at(name)), colour), 0.0) << name;
  }
  for (const char* name : {"g.bmp", "g.pgm", "g.tiff"}) {
    ASSERT_TRUE(cv::imwrite(folder_.at(name), grey)) << name;
    EXPECT_EQ(largest_difference(read_image(folder_.at(name)), grey), 0.0) << name;
  }
}

TEST_F(ImageFile, DamageOfOtherFormatsEndsInAnErrorOrAPictureNeverInACrash) {
  const std::array names = {"a.bmp", "a.ppm", "a.tif", "a.webp"};
  for (const char* name : names) ASSERT_TRUE(cv::imwrite(folder_.at(name), picture(32, 24)));
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    core::Random random(seed);
    std::string bytes = core::read_file(folder_.at(names[seed % names.size()]));
    for (int i = 0; i < 3; ++i)
      bytes[random.index(seed % 3 == 0 ? 64 : bytes.size())] = static_cast<char>(random.next());
    if (seed % 5 == 0) bytes.resize(random.index(bytes.size()));
    folder_.write("bad", bytes);
    EXPECT_THAT(complaint_about("bad"), testing::AnyOf("no error", HasSubstr("bad")));
    complaint_about_depth("bad");
  }
}

TEST_F(ImageFile, AHeaderOfAnotherFormatThatClaimsAHugeImageIsRefused) {
  folder_.write("a.pgm", "P5\n# big\n70000 70000\n255\n");
  EXPECT_THAT(complaint_about("a.pgm"), HasSubstr("is 70000 x 70000 pixels"));
  ASSERT_TRUE(cv::imwrite(folder_.at("a.bmp"), picture(32, 24)));
  std::string bytes = core::read_file(folder_.at("a.bmp"));
  bytes.replace(18, 4, std::string("\0\0\1\0", 4));
  folder_.write("a.bmp", bytes);
  EXPECT_THAT(complaint_about("a.bmp"), HasSubstr("is 65536 x 24 pixels"));
}

// Inks as Photoshop and Pillow store them: 255 less the ink.
TEST_F(ImageFile, CyanMagentaYellowAndBlackBecomeColours) {
  const cv::Mat inks(16, 16, CV_8UC4, cv::Scalar(200, 100, 50, 255));
  const std::unique_ptr<void, int (*)(tjhandle)> encoder(tjInitCompress(), &tjDestroy);
  unsigned char* bytes = nullptr;
  unsigned long num_bytes = 0;  // NOLINT: the library's type
  ASSERT_EQ(tjCompress2(encoder.get(), inks.data, 16, 0, 16, TJPF_CMYK, &bytes, &num_bytes,
                        TJSAMP_444, 98, 0),
            0);
  folder_.write("print.jpg", std::string(reinterpret_cast<const char*>(bytes), num_bytes));
  tjFree(bytes);
  const cv::Mat image = read_image(folder_.at("print.jpg"));
  ASSERT_EQ(image.type(), CV_8UC3);
  EXPECT_LE(cv::norm(image.at<cv::Vec3b>(8, 8), cv::Vec3b(50, 100, 200), cv::NORM_INF), 4.0);
}

TEST_F(ImageFile, AnOrientationInExifIsFound) {
  folder_.write_jpeg("a.jpg", picture(32, 24));
  std::string bytes = core::read_file(folder_.at("a.jpg"));
  EXPECT_EQ(exif_orientation(bytes), 1);
  const std::string tiff("II*\0\x08\0\0\0\1\0\x12\1\3\0\1\0\0\0\6\0\0\0", 22);
  std::string segment = std::string("\xff\xe1\0\0", 4) + std::string("Exif\0\0", 6) + tiff;
  segment[3] = static_cast<char>(segment.size() - 2);
  bytes.insert(2, segment);
  EXPECT_EQ(exif_orientation(bytes), 6);
  for (std::size_t length = 0; length < 60; ++length) exif_orientation(bytes.substr(0, length));
  folder_.write("a.jpg", bytes);
  EXPECT_EQ(read_image(folder_.at("a.jpg")).size(), cv::Size(32, 24)) << "it is not turned";
}

TEST_F(ImageFile, AHeaderThatClaimsAHugeImageIsRefused) {
  folder_.write_jpeg("a.jpg", picture(32, 24));
  std::string bytes = core::read_file(folder_.at("a.jpg"));
  const std::size_t frame_header = bytes.find("\xff\xc0");
  ASSERT_NE(frame_header, std::string::npos);
  bytes.replace(frame_header + 5, 4, "\xff\xdc\xff\xdc");
  folder_.write("a.jpg", bytes);
  EXPECT_THAT(complaint_about("a.jpg"), HasSubstr("is 65500 x 65500 pixels"));
}

TEST_F(ImageFile, DepthIsInMetresAndUnknownIsZero) {
  cv::Mat stored(2, 3, CV_16UC1, cv::Scalar(0));
  stored.at<std::uint16_t>(0, 1) = 1500;
  stored.at<std::uint16_t>(0, 2) = 65535;
  stored.at<std::uint16_t>(1, 0) = 65534;
  stored.at<std::uint16_t>(1, 2) = 258;  // other bytes if read in the wrong order
  folder_.write_png("d.png", stored);
  const cv::Mat depth_m = read_depth(folder_.at("d.png"), 1000.0);
  ASSERT_EQ(depth_m.type(), CV_32FC1);
  ASSERT_EQ(depth_m.size(), stored.size());
  EXPECT_EQ(depth_m.at<float>(0, 0), 0.0F);
  EXPECT_FLOAT_EQ(depth_m.at<float>(0, 1), 1.5F);
  EXPECT_EQ(depth_m.at<float>(0, 2), 0.0F);
  EXPECT_FLOAT_EQ(depth_m.at<float>(1, 0), 65.534F);
  EXPECT_FLOAT_EQ(depth_m.at<float>(1, 2), 0.258F);
  EXPECT_FLOAT_EQ(read_depth(folder_.at("d.png"), 5000.0).at<float>(0, 1), 0.3F);
}

TEST_F(ImageFile, DepthMayBePgmOrTiffToo) {
  cv::Mat stored(2, 3, CV_16UC1, cv::Scalar(1500));
  stored.at<std::uint16_t>(1, 1) = 65535;
  for (const char* name : {"d.pgm", "d.tif"}) {
    ASSERT_TRUE(cv::imwrite(folder_.at(name), stored));
    const cv::Mat depth_m = read_depth(folder_.at(name), 1000.0);
    EXPECT_FLOAT_EQ(depth_m.at<float>(0, 0), 1.5F) << name;
    EXPECT_EQ(depth_m.at<float>(1, 1), 0.0F) << name;
  }
  cv::Mat metres(2, 3, CV_32FC1, cv::Scalar(2.25));
  metres.at<float>(0, 1) = std::numeric_limits<float>::quiet_NaN();
  metres.at<float>(0, 2) = -1.0F;
  ASSERT_TRUE(cv::imwrite(folder_.at("f.tif"), metres));
  const cv::Mat depth_m = read_depth(folder_.at("f.tif"), 1000.0);
  EXPECT_EQ(depth_m.at<float>(0, 0), 2.25F);
  EXPECT_EQ(depth_m.at<float>(0, 1), 0.0F);
  EXPECT_EQ(depth_m.at<float>(0, 2), 0.0F);
  folder_.write("eight.pgm", "P5 1 1 255 a");
  EXPECT_THAT(complaint_about_depth("eight.pgm"), HasSubstr("8 bits per channel"));
}

TEST_F(ImageFile, DepthMustBe16BitGreyPng) {
  folder_.write_png("grey.png", cv::Mat(4, 4, CV_8UC1, cv::Scalar(9)));
  EXPECT_THAT(complaint_about_depth("grey.png"),
              AllOf(HasSubstr("8 bits per channel"), HasSubstr("16-bit grey")));
  folder_.write_png("colour.png", picture(4, 4));
  EXPECT_THAT(complaint_about_depth("colour.png"), HasSubstr("and colour"));
  folder_.write_jpeg("d.jpg", picture(8, 8));
  EXPECT_THAT(complaint_about_depth("d.jpg"), HasSubstr("is not PNG"));
}

}  // namespace
}  // namespace samewhere::input
