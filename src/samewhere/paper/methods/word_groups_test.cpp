#include <gtest/gtest.h>

#include <samewhere/paper/methods/word_groups.hpp>

namespace samewhere::paper {
namespace {

features::Features features_at(const std::vector<Eigen::Vector2f>& pixels,
                               const std::vector<int>& octaves) {
  features::Features features;
  for (const Eigen::Vector2f& pixel : pixels) features.raw_px.push_back(pixel);
  for (const int octave : octaves) features.octave.push_back(octave);
  return features;
}

TEST(WordGroups, AreWordsOfFeaturesThatHaveANeighbourWithinTheirSize) {
  WordGroups dictionary(5.0, 2.0);
  // 4 px apart; the third is 8 px from the second: within its own 10 px, not within the other's 5
  const auto features = features_at({{0, 0}, {4, 0}, {12, 0}}, {0, 0, 1});
  const BagOfWords bag = dictionary.learn(features, {7, 8, 9});
  std::vector<features::Word> words;
  for (const WeightedWord& entry : bag) words.push_back(entry.word);
  EXPECT_EQ(words, (std::vector<features::Word>{7, 8, 9}));
  const auto alone = features_at({{0, 0}, {100, 0}}, {0, 0});
  EXPECT_TRUE(dictionary.learn(alone, {7, 8}).empty());
}

TEST(WordGroups, WeighLessTheOftenerTheyWere) {
  WordGroups dictionary(5.0, 2.0);
  const auto pair = features_at({{0, 0}, {1, 0}}, {0, 0});
  for (int i = 0; i < 5; ++i) dictionary.learn(pair, {1, 2});
  const auto both = features_at({{0, 0}, {1, 0}, {50, 0}, {51, 0}}, {0, 0, 0, 0});
  const BagOfWords bag = dictionary.learn(both, {1, 2, 3, 4});
  ASSERT_EQ(bag.size(), 4U);
  EXPECT_LT(bag[0].weight, bag[2].weight);
}

}  // namespace
}  // namespace samewhere::paper
