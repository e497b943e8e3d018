#include <algorithm>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/input/test_folder.hpp>
#include <samewhere/pairs/labelled_pairs.hpp>

namespace samewhere::pairs {
namespace {

cv::Mat wall(std::uint64_t seed) {
  core::Random random(seed);
  cv::Mat grey(240, 320, CV_8UC1, cv::Scalar(120));
  for (int i = 0; i < 200; ++i) {
    const cv::Point at(static_cast<int>(random.index(310)), static_cast<int>(random.index(230)));
    const cv::Size size(6 + static_cast<int>(random.index(20)), 12);
    cv::rectangle(grey, {at, size}, cv::Scalar(static_cast<double>(random.index(256))), cv::FILLED);
  }
  return grey;
}

// Two floors that differ by nothing, four seconds each; the second floor's last image
// is a query of the data set. A third floor looks like neither.
void make_tower(const input::TestFolder& folder) {
  std::string labels = "image,floor,split,area\n";
  std::string walk = "# image floor clip\n";
  const auto add = [&](const std::string& floor, int second, const cv::Mat& image, bool is_query) {
    const std::string name = fmt::format("{}/{}_{}.png", floor, floor, second);
    folder.write_png(name, image);
    labels += fmt::format("{},{},{},hall\n", name, floor, is_query ? "query" : "gallery");
    walk += fmt::format("{} {} {}_c1\n", name, floor, floor);
  };
  for (int second = 0; second < 4; ++second) add("floor1", second, wall(1), false);
  for (int second = 0; second < 4; ++second) add("floor2", second, wall(1), second == 3);
  for (int second = 0; second < 2; ++second) add("floor3", second, wall(2), false);
  folder.write("dataset.csv", labels);
  folder.write("walk.txt", walk);
}

int num_of(const LabelledPairs& labelled, int query, bool is_same) {
  return static_cast<int>(std::count_if(
      labelled.pairs.begin(), labelled.pairs.end(),
      [&](const LabelledPair& pair) { return pair.query == query && pair.is_same == is_same; }));
}

TEST(LabelledPairs, OfATowerNeighboursInAClipAreTrueAndFloorsThatLookAlikeAreWrong) {
  const input::TestFolder folder;
  make_tower(folder);
  const LabelledPairs labelled = labelled_pairs(folder.root().string(), {.query_step = 1});
  EXPECT_EQ(labelled.views.size(), 9U);  // the query of the data set is left out
  EXPECT_EQ(num_of(labelled, 0, true), 2);
  EXPECT_EQ(num_of(labelled, 1, true), 3);
  EXPECT_EQ(num_of(labelled, 0, false), 3);  // those of the floor that looks like it
  EXPECT_EQ(num_of(labelled, 8, true), 1);
  EXPECT_EQ(num_of(labelled, 8, false), 0);
  for (const LabelledPair& pair : labelled.pairs) EXPECT_GE(pair.matches.size(), 20U);
}

TEST(LabelledPairs, OfATowerEveryStepthViewIsAQuery) {
  const input::TestFolder folder;
  make_tower(folder);
  const LabelledPairs labelled = labelled_pairs(folder.root().string(), {.query_step = 4});
  EXPECT_EQ(labelled.views.size(), 9U);
  for (const LabelledPair& pair : labelled.pairs) EXPECT_EQ(pair.query % 4, 0);
}

TEST(LabelledPairs, OfATowerSomeFloorsCanBeTaken) {
  const input::TestFolder folder;
  make_tower(folder);
  const auto floors = [&](const std::string& names) {
    return labelled_pairs(folder.root().string() + "?floors=" + names, {.query_step = 1});
  };
  const LabelledPairs one = floors("floor2");
  EXPECT_EQ(one.views.size(), 3U);
  EXPECT_EQ(num_of(one, 0, true), 2);
  EXPECT_EQ(num_of(one, 0, false), 0);
  EXPECT_EQ(floors("floor1,floor2").views.size(), 7U);
  EXPECT_THROW(floors("floor1,floor7"), core::InputError);
  EXPECT_THROW(floors(""), core::InputError);
}

TEST(LabelledPairs, PairsOfFewerMatchesAreLeftOut) {
  const input::TestFolder folder;
  make_tower(folder);
  EXPECT_TRUE(labelled_pairs(folder.root().string(), {.min_matches = 5000}).pairs.empty());
}

TEST(LabelledPairs, ARecordingWithoutPlaceTruthIsRefused) {
  const input::TestFolder folder;
  for (int i = 0; i < 2; ++i) folder.write_png(fmt::format("{}.png", i), wall(1));
  EXPECT_THROW(labelled_pairs(folder.root().string(), {.step = 1}), core::InputError);
}

}  // namespace
}  // namespace samewhere::pairs
