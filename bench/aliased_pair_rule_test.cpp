#include "aliased_pair_rule.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tower.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>

namespace samewhere::bench {
namespace {

TEST(AliasedPairRule, TheQuerysPlaceAndTimeAreTakenOut) {
  KnownFrames frames;
  frames.truth.places = core::PlaceTruthMatrix{
      .num_frames = 4, .values = std::vector<core::PlaceTruth>(16, core::PlaceTruth::kDifferent)};
  frames.truth.places->values[3 * 4 + 0] = core::PlaceTruth::kNear;
  for (int i = 0; i < 4; ++i) {
    frames.names.push_back(std::to_string(i));
    frames.stamps_s.push_back(6.0 * i);
  }
  const AliasedPairRule rule = rules_of_truth(frames, 2).front();
  EXPECT_THAT(rule.queries, testing::ElementsAre(0, 2));
  EXPECT_EQ(rule.offer(0, 1), Offer::kTakenOut);  // six seconds later
  EXPECT_EQ(rule.offer(0, 2), Offer::kAliased);
  EXPECT_EQ(rule.offer(0, 3), Offer::kTakenOut);  // near, in the other order
  EXPECT_THROW(rules_of_truth(KnownFrames(), 1), core::InputError);
}

TEST(AliasedPairRule, OnlyListedPairsAreOfferedInBothOrders) {
  KnownFrames frames;
  frames.truth.aliased_pairs = {{.query = 3, .match = 1}, {.query = 9, .match = 4}};
  const std::vector<AliasedPairRule> rules = rules_of_truth(frames, 2);
  ASSERT_EQ(rules.size(), 1U);
  EXPECT_THAT(rules[0].queries, testing::ElementsAre(1, 3, 9));  // 4 is too near 3
  EXPECT_EQ(rules[0].offer(3, 1), Offer::kAliased);
  EXPECT_EQ(rules[0].offer(1, 3), Offer::kAliased);
  EXPECT_EQ(rules[0].offer(3, 4), Offer::kTakenOut);
}

TEST(AliasedPairRule, OnTheTowerOtherFloorsAreAliased) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "tower";
  core::make_writable_folder(folder);
  core::write_file(folder / "dataset.csv",
                   "image,floor,split,area\na1,f1,gallery,x y\na2,f1,query,x\nb1,f1,gallery,x\n"
                   "c1,f2,gallery,x\n");
  core::write_file(folder / "walk.txt", "a1 f1 a\na2 f1 a\nb1 f1 b\nc1 f2 c\n");
  ASSERT_TRUE(is_tower(folder));
  const AliasedPairRule rule = tower_rule(folder, 150);
  EXPECT_THAT(rule.queries, testing::ElementsAre(1));
  EXPECT_EQ(rule.offer(1, 0), Offer::kTakenOut);
  EXPECT_EQ(rule.offer(1, 2), Offer::kSamePlace);
  EXPECT_EQ(rule.offer(1, 3), Offer::kAliased);
  core::write_file(folder / "walk.txt", "a1 f1 a\nd9 f1 a\n");
  EXPECT_THROW(tower_rule(folder, 150), core::InputError);
}

}  // namespace
}  // namespace samewhere::bench
