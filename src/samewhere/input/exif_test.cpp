#include <string>

#include <gtest/gtest.h>

#include <samewhere/core/random.hpp>
#include <samewhere/input/exif.hpp>

namespace samewhere::input {
namespace {

// The head of a JPEG whose EXIF says a focal length in 35 mm.
std::string jpeg_head(bool is_little, unsigned length_mm) {
  const auto number = [&](unsigned value, int size) {
    std::string bytes;
    for (int i = 0; i < size; ++i) {
      const int shift = 8 * (is_little ? i : size - 1 - i);
      bytes += static_cast<char>((value >> static_cast<unsigned>(shift)) & 0xFFU);
    }
    return bytes;
  };
  const std::string tiff = std::string(is_little ? "II" : "MM") + number(42, 2) + number(8, 4) +
                           number(1, 2) + number(0x8769, 2) + number(4, 2) + number(1, 4) +
                           number(26, 4) + number(0, 4) + number(1, 2) + number(0xA405, 2) +
                           number(3, 2) + number(1, 4) + number(length_mm, 2) + number(0, 2);
  return std::string("\xFF\xD8\xFF\xE1\0\x40", 6) + std::string("Exif\0\0", 6) + tiff;
}

TEST(Exif, TheFocalLengthOf35mmFilmIsReadInEitherByteOrder) {
  EXPECT_EQ(focal_length_35mm(jpeg_head(true, 28)), 28.0);
  EXPECT_EQ(focal_length_35mm(jpeg_head(false, 26)), 26.0);
}

TEST(Exif, NothingWhereItIsUnknownOrMissing) {
  EXPECT_FALSE(focal_length_35mm(jpeg_head(true, 0)));
  EXPECT_FALSE(focal_length_35mm(""));
  EXPECT_FALSE(focal_length_35mm("\xFF\xD8 no exif"));
  EXPECT_FALSE(focal_length_35mm("PNG" + jpeg_head(true, 28)));
}

TEST(Exif, DamagedDataIsNeverReadBeyondItsEnd) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    core::Random random(seed);
    std::string head = jpeg_head(seed % 2 == 0, 28);
    head.resize(head.size() - random.index(40));
    for (int i = 0; i < 4; ++i)
      head[12 + random.index(head.size() - 12)] = static_cast<char>(random.index(256));
    const auto found = focal_length_35mm(head);
    EXPECT_TRUE(!found || (*found > 0.0 && *found <= 2000.0)) << "seed " << seed;
  }
}

}  // namespace
}  // namespace samewhere::input
