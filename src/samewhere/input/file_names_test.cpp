#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/random.hpp>
#include <samewhere/input/file_names.hpp>
#include <samewhere/input/test_folder.hpp>

namespace samewhere::input {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(FileNames, TwoComesBeforeTen) {
  std::vector<std::string> names = {"10.jpg", "2.jpg", "b1.jpg", "a10.jpg",
                                    "01.jpg", "1.jpg", "a9.jpg", "99999999999999999999999.jpg",
                                    "3"};
  std::sort(names.begin(), names.end(), &natural_less);
  EXPECT_THAT(names, ElementsAre("01.jpg", "1.jpg", "2.jpg", "3", "10.jpg",
                                 "99999999999999999999999.jpg", "a9.jpg", "a10.jpg", "b1.jpg"));
}

TEST(FileNames, TheOrderIsStrictAndTotal) {
  const std::string letters = "01209ab.-";
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    core::Random random(seed);
    std::vector<std::string> names(3);
    for (std::string& name : names) {
      for (std::uint64_t n = random.index(6); n > 0; --n) name += letters[random.index(9)];
    }
    const auto& [a, b, c] = std::tie(names[0], names[1], names[2]);
    EXPECT_FALSE(natural_less(a, a)) << a;
    EXPECT_EQ(natural_less(a, b) || natural_less(b, a), a != b) << a << " " << b;
    EXPECT_FALSE(natural_less(a, b) && natural_less(b, a)) << a << " " << b;
    if (natural_less(a, b) && natural_less(b, c)) {
      EXPECT_TRUE(natural_less(a, c)) << a << " " << b << " " << c;
    }
  }
}

TEST(FileNames, TheFrameNumberIsTheLastNumberBeforeTheExtension) {
  EXPECT_EQ(frame_number("frame-000012.color.jpg"), 12);
  EXPECT_EQ(frame_number("00377.png"), 377);
  EXPECT_EQ(frame_number("b4_hall_c024_frame_000001.jpg"), 1);
  EXPECT_EQ(frame_number("clip7.mp4"), 7);
  EXPECT_EQ(frame_number("123456789.png"), 123456789);
  EXPECT_EQ(frame_number("0000000012.png"), 12);
  EXPECT_EQ(frame_number("0000000000.png"), 0);
  EXPECT_EQ(frame_number("1403636579763555584.png"), std::nullopt);
  EXPECT_EQ(frame_number("door.jpg"), std::nullopt);
  EXPECT_EQ(frame_number(""), std::nullopt);
}

TEST(FileNames, ImagesAreToldByTheirEnding) {
  EXPECT_TRUE(is_image_name("a.jpg"));
  EXPECT_TRUE(is_image_name("a.JPEG"));
  EXPECT_TRUE(is_image_name("a.b.Png"));
  EXPECT_TRUE(is_image_name("a.PGM"));
  EXPECT_TRUE(is_image_name("a.tiff"));
  EXPECT_FALSE(is_image_name("same_place.pgm"));
  EXPECT_FALSE(is_image_name("._a.jpg"));
  EXPECT_FALSE(is_image_name("a.txt"));
  EXPECT_FALSE(is_image_name("jpg"));
}

TEST(FileNames, AFolderThatIsNotThereIsNamed) {
  const TestFolder folder;
  EXPECT_THAT(complaint([&] { sorted_names(folder.root() / "gone"); }), HasSubstr("gone"));
}

}  // namespace
}  // namespace samewhere::input
