#include <gtest/gtest.h>

#include <samewhere/paper/methods/bag_of_words.hpp>
#include <samewhere/paper/methods/consistency.hpp>
#include <samewhere/paper/methods/islands.hpp>

namespace samewhere::paper {
namespace {

using features::Word;

double weight_one(Word /*word*/) { return 1.0; }

TEST(BagOfWords, ItsScoreIsOneMinusHalfTheDistance) {
  const BagOfWords a = make_bag({3, 3, 1, 5}, BagNorm::kL1, weight_one);
  const BagOfWords b = make_bag({3, 5, 7, 7}, BagNorm::kL1, weight_one);
  ASSERT_EQ(a.size(), 3U);
  EXPECT_EQ(a[1].word, 3U);
  EXPECT_DOUBLE_EQ(a[1].weight, 0.5);
  // |a - b| = .25 + .25 + 0 + .5
  EXPECT_DOUBLE_EQ(score_of(a, b, BagNorm::kL1), 1.0 - 1.0 / 2.0);
  EXPECT_DOUBLE_EQ(score_of(a, a, BagNorm::kL1), 1.0);
  EXPECT_DOUBLE_EQ(score_of(a, {}, BagNorm::kL1), 0.0);
  const BagOfWords c = make_bag({3, 3, 1, 5}, BagNorm::kL2, weight_one);
  EXPECT_NEAR(score_of(c, c, BagNorm::kL2), 1.0, 1e-7);
  EXPECT_DOUBLE_EQ(score_of(c, make_bag({9}, BagNorm::kL2, weight_one), BagNorm::kL2), 0.0);
}

TEST(BagOfWords, AWordWithoutWeightIsLeftOut) {
  const BagOfWords bag =
      make_bag({1, 2, 2}, BagNorm::kL1, [](Word word) { return word == 2 ? 0.0 : 4.0; });
  ASSERT_EQ(bag.size(), 1U);
  EXPECT_DOUBLE_EQ(bag[0].weight, 1.0);
  EXPECT_TRUE(make_bag({}, BagNorm::kL1, weight_one).empty());
}

TEST(InvertedFile, ScoresAsTheBagsThemselves) {
  const std::vector<std::vector<Word>> views = {{1, 2, 3}, {4, 4, 5}, {1, 1, 5}, {6}};
  for (const BagNorm norm : {BagNorm::kL1, BagNorm::kL2}) {
    InvertedFile file(10, norm);
    for (const auto& words : views) file.append(make_bag(words, norm, weight_one));
    const BagOfWords query = make_bag({1, 5, 5, 6}, norm, weight_one);
    const std::vector<ScoredBag> found = file.search(query, 3);
    ASSERT_EQ(found.size(), 3U) << "the fourth is not allowed";
    for (const ScoredBag& view : found) {
      const BagOfWords other =
          make_bag(views[static_cast<std::size_t>(view.position)], norm, weight_one);
      EXPECT_NEAR(view.score, score_of(query, other, norm), 1e-12);
      EXPECT_EQ(view.num_shared, view.position == 2 ? 2 : 1);
    }
    EXPECT_EQ(best_scored(found, 1).front().position, 2);
    EXPECT_TRUE(file.search(query, 0).empty());
  }
}

TEST(Consistency, ACandidateHasToBeNearThoseOfQueriesInARow) {
  Consistency consistency(10, 2);
  EXPECT_TRUE(consistency.consistent_of({{.position = 100}}).empty());
  EXPECT_TRUE(consistency.consistent_of({{.position = 105}, {.position = 500}}).empty());
  const auto found = consistency.consistent_of({{.position = 300}, {.position = 115}});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.front().position, 115);
  EXPECT_TRUE(consistency.consistent_of({}).empty());
  EXPECT_TRUE(consistency.consistent_of({{.position = 115}}).empty()) << "the row has ended";
}

TEST(Islands, TheLargestSumCountsNotTheBestView) {
  const std::vector<ScoredBag> scored = {{.position = 1, .score = 0.9},
                                         {.position = 10, .score = 0.5},
                                         {.position = 11, .score = 0.1},
                                         {.position = 12, .score = 0.6}};
  const auto island = best_island(scored, 0.4, 3);
  ASSERT_TRUE(island.has_value());
  EXPECT_EQ(island->begin, 10);
  EXPECT_EQ(island->end, 12);
  EXPECT_EQ(island->best.position, 12);
  EXPECT_EQ(best_island(scored, 0.4, 2)->begin, 1) << "a gap of two ends an island";
  EXPECT_FALSE(best_island(scored, 0.95, 3).has_value());
  EXPECT_TRUE(are_near(*island, {.begin = 13, .end = 20}, 1));
  EXPECT_TRUE(are_near(*island, {.begin = 11, .end = 11}, 1));
  EXPECT_FALSE(are_near(*island, {.begin = 14, .end = 20}, 1));
  EXPECT_FALSE(are_near({.begin = 14, .end = 20}, *island, 1));
}

}  // namespace
}  // namespace samewhere::paper
