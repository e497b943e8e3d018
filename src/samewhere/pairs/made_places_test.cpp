#include <limits>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/test_folder.hpp>
#include <samewhere/pairs/labelled_pairs.hpp>
#include <samewhere/pairs/made_places.hpp>

namespace samewhere::pairs {
namespace {

cv::Mat wall(std::uint64_t seed) {
  core::Random random(seed);
  cv::Mat grey(240, 320, CV_8UC1, cv::Scalar(120));
  for (int i = 0; i < 250; ++i) {
    const cv::Point at(static_cast<int>(random.index(310)), static_cast<int>(random.index(230)));
    const cv::Size size(6 + static_cast<int>(random.index(20)), 12);
    cv::rectangle(grey, {at, size}, cv::Scalar(static_cast<double>(random.index(256))), cv::FILLED);
  }
  return grey;
}

TEST(PhotoSource, AFolderAndWhichOfItsPhotos) {
  EXPECT_TRUE(is_photos("photos:a/b"));
  EXPECT_FALSE(is_photos("a/photos:b"));
  const PhotoSource all = photo_source("photos:a/b");
  EXPECT_EQ(all.folder, "a/b");
  EXPECT_EQ(all.first, 0);
  EXPECT_EQ(all.last, std::numeric_limits<int>::max());
  const PhotoSource some = photo_source("photos:a/b?from=20&to=99");
  EXPECT_EQ(some.folder, "a/b");
  EXPECT_EQ(some.first, 20);
  EXPECT_EQ(some.last, 99);
  for (const char* bad : {"photos:a?from=", "photos:a?from=x", "photos:a?to=-1", "photos:a?form=3"})
    EXPECT_THROW(photo_source(bad), core::InputError) << bad;
}

TEST(MadeViews, TheSeedDecidesAndColouredPhotosAreAMistakeOfOurs) {
  const Ingredients ingredients{wall(1), wall(2), wall(3), wall(4)};
  core::Random first(1);
  core::Random again(1);
  core::Random other(2);
  const auto views = made_views(ingredients, first);
  const auto same = made_views(ingredients, again);
  const auto different = made_views(ingredients, other);
  for (std::size_t i = 0; i < views.size(); ++i) {
    ASSERT_EQ(views[i].size(), kMadeView_px);
    ASSERT_EQ(views[i].type(), CV_8UC1);
    EXPECT_EQ(cv::norm(views[i], same[i], cv::NORM_INF), 0.0);
    EXPECT_GT(cv::norm(views[i], different[i], cv::NORM_INF), 50.0);
  }
  core::Random random(1);
  Ingredients coloured = ingredients;
  cv::cvtColor(coloured.own, coloured.own, cv::COLOR_GRAY2BGR);
  EXPECT_THROW(made_views(coloured, random), core::ContractError);
}

TEST(MadeViews, ALookAlikeSharesLessThanAnotherViewOfThePlace) {
  const input::TestFolder folder;
  for (int i = 0; i < 64; ++i)
    folder.write_png(fmt::format("{}.png", i), wall(static_cast<std::uint64_t>(i)));
  const LabelledPairs labelled =
      labelled_pairs("photos:" + folder.at("").string(), {.min_matches = 12});
  ASSERT_EQ(labelled.views.size(), 4U * 64U);
  double num_matches[2] = {0.0, 0.0};
  int num_pairs[2] = {0, 0};
  for (const LabelledPair& pair : labelled.pairs) {
    EXPECT_EQ(pair.query / 4, pair.match / 4) << "of one photo";
    EXPECT_EQ(pair.is_same, pair.query / 2 == pair.match / 2);
    num_matches[pair.is_same ? 1 : 0] += static_cast<double>(pair.matches.size());
    ++num_pairs[pair.is_same ? 1 : 0];
  }
  ASSERT_GT(num_pairs[1], 80);
  ASSERT_GT(num_pairs[0], 40) << "look-alikes that share nothing teach nothing";
  EXPECT_GT(num_matches[1] / num_pairs[1], 1.3 * num_matches[0] / num_pairs[0]);
}

TEST(MadeViews, AFewPhotosAreNotEnough) {
  const input::TestFolder folder;
  for (int i = 0; i < 3; ++i) folder.write_png(fmt::format("{}.png", i), wall(1));
  EXPECT_THROW(labelled_pairs("photos:" + folder.at("").string(), {}), core::InputError);
}

}  // namespace
}  // namespace samewhere::pairs
