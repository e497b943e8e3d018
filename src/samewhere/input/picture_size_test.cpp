#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/picture_size.hpp>

namespace samewhere::input {
namespace {

std::string complaint_about(std::int64_t width_px, std::int64_t height_px) {
  try {
    require_reasonable_size("wall.png", width_px, height_px);
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(PictureSize, OfCamerasIsTaken) {
  EXPECT_EQ(complaint_about(1, 1), "none");
  EXPECT_EQ(complaint_about(8000, 8000), "none");
  EXPECT_EQ(complaint_about(9504, 6336), "none");
}

TEST(PictureSize, WithoutPixelsIsADamagedFile) {
  EXPECT_EQ(complaint_about(0, 480), "wall.png: damaged image file: it ends before the picture");
  EXPECT_THAT(complaint_about(640, -1), testing::HasSubstr("damaged image file"));
}

TEST(PictureSize, BeyondTheLimitNamesFileSizeAndLimit) {
  EXPECT_THAT(complaint_about(60'000, 60'000),
              testing::AllOf(testing::StartsWith("wall.png: is 60000 x 60000 pixels by its header"),
                             testing::HasSubstr("64 megapixels")));
  EXPECT_NE(complaint_about(8001, 8000), "none");
  EXPECT_NE(complaint_about(32'768, 1), "none") << "one row as long as the limit of pixels";
  const std::int64_t most = std::numeric_limits<std::int64_t>::max();
  EXPECT_NE(complaint_about(most, most), "none") << "the product does not fit";
}

}  // namespace
}  // namespace samewhere::input
