#include <cstdlib>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/input/test_folder.hpp>
#include <samewhere/train/image_set.hpp>
#include <samewhere/train/test_images.hpp>

namespace samewhere::train {
namespace {

using input::complaint;
using testing::HasSubstr;

ImageSet read(const std::vector<std::string>& sources, const Config& config = test_config()) {
  return read_images(sources, {}, config, [](const std::string&, int, int) {});
}

ImageSet read_to_validate(const std::vector<std::string>& sources,
                          const std::vector<std::string>& validate) {
  return read_images(sources, validate, test_config(), [](const std::string&, int, int) {});
}

// Sources of so many views each, without the views.
ImageSet sources_of(const std::vector<int>& nums_images) {
  ImageSet images;
  for (const int num_images : nums_images) images.sources.push_back({"source", num_images});
  return images;
}

TEST(ImageSet, AnUnreadableImageIsSkippedAndCounted) {
  const input::TestFolder folder;
  folder.write_png("photos/1.png", test_picture(1));
  folder.write_png("photos/2.png", test_picture(2));
  folder.cut("photos/2.png", 0.5);
  folder.write("photos/3.jpg", "no picture");
  folder.write_png("photos/4.png", test_picture(4, {100, 300}));  // another size is no harm
  const ImageSet images = read({folder.at("photos").string()});
  ASSERT_EQ(images.sources.size(), 1U);
  EXPECT_EQ(images.sources[0].num_images, 2);
  EXPECT_EQ(images.sources[0].num_unreadable, 2);
  ASSERT_EQ(images.views.size(), 2U);
  EXPECT_EQ(images.views[1].size(), cv::Size(320, 240));
}

TEST(ImageSet, WhatGivesNoImageIsNamed) {
  const input::TestFolder folder;
  std::filesystem::create_directories(folder.root() / "empty");
  EXPECT_THAT(complaint([&] { read({(folder.root() / "empty").string()}); }), HasSubstr("empty"));
  EXPECT_THAT(complaint([&] { read({(folder.root() / "none").string()}); }), HasSubstr("none"));
  folder.write("broken/1.png", "no picture");
  EXPECT_THAT(complaint([&] { read({folder.at("broken").string()}); }),
              testing::AllOf(HasSubstr("broken"), HasSubstr("can be read")));
  folder.write_png("single/1.png", test_picture(1));
  EXPECT_THAT(complaint([&] { read({folder.at("single").string()}); }), HasSubstr("at least 2"));
  EXPECT_THAT(complaint([&] { read({"twin:nowhere"}); }), HasSubstr("nowhere"));
}

TEST(ImageSet, TheChecksumTellsPixelsApart) {
  const input::TestFolder folder;
  for (int i = 0; i < 3; ++i) {
    folder.write_png("a/" + std::to_string(i) + ".png", test_picture(i));
    folder.write_png("b/" + std::to_string(i) + ".png", test_picture(i + 1));
  }
  const std::string a = folder.at("a").string();
  EXPECT_EQ(read({a}).sha256, read({a}).sha256);
  EXPECT_NE(read({a}).sha256, read({folder.at("b").string()}).sha256);
}

TEST(ImageSet, ARenderedWalkGivesEachNthFrame) {
  Config config = test_config();
  config.twin_step = 400;
  const ImageSet images = read({"twin:office-loop?seed=3"}, config);
  ASSERT_GE(images.views.size(), 2U);
  EXPECT_GT(cv::norm(images.views[0], images.views[1], cv::NORM_L1), 0.0);
  const core::PlaceTruthMatrix& places = images.sources[0].places;
  ASSERT_EQ(places.num_frames, static_cast<int>(images.views.size()));
  EXPECT_EQ(places.at(1, 1), core::PlaceTruth::kSame);
  EXPECT_EQ(places.at(0, 1), core::PlaceTruth::kDifferent) << "27 s apart on a lap";
}

TEST(ImageSet, ASourceToValidateWithIsKeptApart) {
  const input::TestFolder folder;
  for (int i = 0; i < 5; ++i) {
    folder.write_png((i < 3 ? "a/" : "b/") + std::to_string(i) + ".png", test_picture(i));
  }
  const std::string a = folder.at("a").string();
  const std::string b = folder.at("b").string();
  const ImageSet images = read_to_validate({a}, {b});
  const Split split = split_views(images, 0);
  EXPECT_THAT(split.training, testing::ElementsAre(0, 1, 2));
  EXPECT_THAT(split.validation, testing::ElementsAre(3, 4));
  EXPECT_NE(images.sha256, read({a, b}).sha256) << "the same pixels, used otherwise";
}

TEST(ImageSet, WhatIsLearntFromDoesNotValidate) {
  const input::TestFolder folder;
  const std::string photos = folder.at("photos/1.png").parent_path().string();
  EXPECT_THAT(complaint([&] { read_to_validate({photos}, {photos + "/../photos"}); }),
              testing::AllOf(HasSubstr("--validate"), HasSubstr("not seen in training")));
  EXPECT_THAT(complaint([&] {
                read_to_validate({"twin:hotel?seed=3"}, {"twin:hotel?similarity=0.5&seed=3"});
              }),
              HasSubstr("--validate twin:hotel?similarity=0.5&seed=3"));
}

TEST(Split, HoldsBackWholeBlocksAndAboutATenth) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    constexpr int kNumImages = 3210;
    const Split split = split_views(sources_of({kNumImages}), seed);
    EXPECT_NEAR(static_cast<double>(split.validation.size()) / kNumImages, 0.1, 0.02);
    EXPECT_GT(static_cast<double>(split.training.size()) / kNumImages, 0.83);
    std::set<int> blocks;
    for (const int index : split.validation) blocks.insert(index / 32);
    for (const int index : split.training) EXPECT_EQ(blocks.count(index / 32), 0U) << index;
    EXPECT_GE(split.validation.size(), 32 * (blocks.size() - 1)) << "whole blocks";
  }
}

TEST(Split, WithinASourceNothingIsLearntNextToWhatIsHeldBack) {
  const ImageSet images = sources_of({700, 33, 1, 900});
  int num_across = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    const Split split = split_views(images, seed);
    for (const int seen : split.training) {
      for (const int held_back : split.validation) {
        if (std::abs(seen - held_back) > 8) continue;
        ASSERT_NE(source_of(images, seen), source_of(images, held_back)) << seen;
        ++num_across;
      }
    }
  }
  EXPECT_GT(num_across, 0) << "another source is another place, however near in the order";
}

TEST(Split, OfAFewImagesLeavesSomeOnBothSides) {
  for (int num_images = 2; num_images < 200; ++num_images) {
    const Split split = split_views(sources_of({num_images}), 7);
    EXPECT_GE(split.training.size(), static_cast<std::size_t>(num_images) / 2) << num_images;
    EXPECT_FALSE(split.validation.empty()) << num_images;
  }
}

}  // namespace
}  // namespace samewhere::train
