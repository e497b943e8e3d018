#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/checksum.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/input/test_folder.hpp>
#include <samewhere/train/pair_set.hpp>
#include <samewhere/train/test_pairs.hpp>

namespace samewhere::train {
namespace {

using input::complaint;
using testing::HasSubstr;

TEST(PackedPair, ComesBackWithinAStepAndZeroAndOneAsTheyWere) {
  cv::Mat planes = test_planes(1, false);
  core::Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const int row = static_cast<int>(random.index(static_cast<std::uint64_t>(planes.rows)));
    const int column = static_cast<int>(random.index(static_cast<std::uint64_t>(planes.cols)));
    const bool is_picture = row < 2 * verify::kPairSide_px;
    planes.at<float>(row, column) =
        static_cast<float>(random.uniform(is_picture ? -1.0 : 0.0, 1.0));
  }
  const cv::Mat back = unpacked(packed(planes));
  EXPECT_LE(cv::norm(planes, back, cv::NORM_INF), 0.5 / 127.0 + 1e-6);
  for (const float exact : {0.0F, 1.0F}) {
    const cv::Mat at = planes == exact;
    EXPECT_GT(cv::countNonZero(at), 100);
    EXPECT_EQ(cv::norm(planes, back, cv::NORM_INF, at), 0.0) << exact;
  }
}

TEST(PairSet, KeptInAFileComesBack) {
  const input::TestFolder folder;
  const PairSet written = test_pairs(4);
  write_pairs(folder.at("pairs"), written, "these sources");
  const PairSet read = load_pairs(folder.at("pairs"), "these sources");
  ASSERT_EQ(read.pairs.size(), written.pairs.size());
  for (std::size_t i = 0; i < read.pairs.size(); ++i) {
    EXPECT_EQ(read.pairs[i].is_same, written.pairs[i].is_same);
    EXPECT_EQ(cv::norm(read.pairs[i].planes, written.pairs[i].planes, cv::NORM_INF), 0.0);
  }
  ASSERT_EQ(read.sources.size(), 2U);
  EXPECT_EQ(read.sources[1].source, "other pictures");
  EXPECT_EQ(read.sources[1].num_wrong, 2);
  EXPECT_TRUE(read.sources[1].is_held_back);
  EXPECT_EQ(read.sha256.size(), 64U);
}

TEST(PairSet, OfOtherSourcesCutOrDamagedIsRefused) {
  const input::TestFolder folder;
  write_pairs(folder.at("pairs"), test_pairs(2), "these sources");
  EXPECT_THAT(complaint([&] { load_pairs(folder.at("pairs"), "others"); }),
              HasSubstr("of other sources"));
  std::string bytes = core::read_file(folder.at("pairs"));
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  core::write_file(folder.at("changed"), bytes);
  EXPECT_THAT(complaint([&] { load_pairs(folder.at("changed"), "these sources"); }),
              HasSubstr("damaged"));
  folder.cut("pairs", 0.9);
  EXPECT_THAT(complaint([&] { load_pairs(folder.at("pairs"), "these sources"); }),
              HasSubstr("damaged"));
  folder.write("foreign", "a shopping list\n");
  EXPECT_THAT(complaint([&] { load_pairs(folder.at("foreign"), ""); }), HasSubstr("no file of"));
}

TEST(PairSet, ABuildingIsNotLearntFromAndValidatedWith) {
  const std::vector<std::string> learnt = {"twin:hotel?seed=3&similarity=0.9"};
  const std::vector<std::string> held_back = {"twin:hotel?seed=3&similarity=0.8"};
  EXPECT_THAT(complaint([&] { read_pairs(learnt, held_back, test_pair_config()); }),
              HasSubstr("is learnt from, too"));
}

// A folder as of IE Tower, of two floors that look alike, two images each; its name.
std::string make_tower(const input::TestFolder& folder, const std::string& name) {
  core::Random random(core::checksum(name));
  cv::Mat wall(240, 320, CV_8UC1, cv::Scalar(120));
  for (int i = 0; i < 200; ++i) {
    const cv::Point at(static_cast<int>(random.index(310)), static_cast<int>(random.index(230)));
    const cv::Size size(6 + static_cast<int>(random.index(20)), 12);
    cv::rectangle(wall, {at, size}, cv::Scalar(static_cast<double>(random.index(256))), cv::FILLED);
  }
  std::string labels = "image,floor,split,area\n";
  std::string walk;
  for (const std::string floor : {"floor1", "floor2"}) {
    for (const char second : {'0', '1'}) {
      const std::string image = floor + "/" + second + ".png";
      folder.write_png(name + "/" + image, wall);
      labels += image + "," + floor + ",gallery,hall\n";
      walk += image + " " + floor + " " + floor + "_c1\n";
    }
  }
  folder.write(name + "/dataset.csv", labels);
  folder.write(name + "/walk.txt", walk);
  return folder.at(name).string();
}

TEST(PairSet, AFloorIsNotLearntFromAndValidatedWith) {
  const input::TestFolder folder;
  const std::string tower = make_tower(folder, "tower");
  PairConfig config = test_pair_config();
  config.query_step = 1;
  const auto read = [&](const std::string& learnt, const std::string& held_back) {
    const std::vector<std::string> sources = {learnt};
    const std::vector<std::string> validate = {held_back};
    return complaint([&] { read_pairs(sources, validate, config); });
  };
  EXPECT_THAT(read(tower + "?floors=floor1", tower + "?floors=floor1,floor2"),
              HasSubstr("is learnt from, too"));
  EXPECT_THAT(read(tower, tower + "?floors=floor2"), HasSubstr("is learnt from, too"));
  // other floors are other places; that one floor alone has no look-alikes is another complaint
  EXPECT_THAT(read(tower + "?floors=floor1", tower + "?floors=floor2"),
              HasSubstr("0 of two that look alike"));
}

TEST(PairSet, IsTheSameWhateverTheThreads) {
  const input::TestFolder folder;
  std::vector<std::string> learnt;
  for (const std::string name : {"a", "b", "c", "d", "e"})
    learnt.push_back(make_tower(folder, name));
  const std::vector<std::string> held_back = {make_tower(folder, "f")};
  PairConfig config = test_pair_config();
  config.query_step = 1;
  const PairSet one = read_pairs(learnt, held_back, config);
  config.threads = 3;
  const PairSet three = read_pairs(learnt, held_back, config);
  ASSERT_EQ(one.sources.size(), 6U);
  for (std::size_t i = 0; i < one.sources.size(); ++i)
    EXPECT_EQ(three.sources[i].source, one.sources[i].source);
  EXPECT_TRUE(one.sources.back().is_held_back);
  EXPECT_EQ(three.sha256, one.sha256);
}

TEST(PairSet, TheIndicesAreThoseOfTheSources) {
  const PairSet set = test_pairs(4);
  EXPECT_THAT(pairs_of(set, false), testing::ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
  EXPECT_THAT(pairs_of(set, true), testing::ElementsAre(8, 9, 10, 11));
}

}  // namespace
}  // namespace samewhere::train
