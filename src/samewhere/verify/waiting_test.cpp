#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/verify/waiting.hpp>

namespace samewhere::verify {
namespace {

Config few_views() {
  Config config;
  config.require_pose = false;
  config.min_views = 4;
  config.max_pending_views = 6;
  return config;
}

// Views of a camera without depth: frame and view have one number.
void add(Waiting& waiting, int query, int match, bool is_foretold = false,
         bool is_by_features = false) {
  core::Evidence evidence{.similarity = 0.8};
  evidence.geometry =
      core::GeometryEvidence{.num_matches = 100, .num_inliers = 30, .spread_ratio = 0.05};
  evidence.sequence = core::SequenceEvidence{.query_view = query, .match_view = match};
  waiting.add({.id = core::CandidateId(static_cast<std::uint64_t>(1000 * query + match)),
               .query = core::FrameId(static_cast<std::uint64_t>(query)),
               .match = core::FrameId(static_cast<std::uint64_t>(match)),
               .similarity = 0.8,
               .is_foretold = is_foretold,
               .is_by_features = is_by_features},
              evidence);
}

// "query-match verdict" of each row.
std::vector<std::string> told(const std::vector<core::LedgerRow>& rows) {
  std::vector<std::string> told;
  for (const auto& row : rows) {
    told.push_back(std::to_string(row.candidate.query.index()) + "-" +
                   std::to_string(row.candidate.match.index()) + " " +
                   std::string(core::name_of(row.verdict)));
  }
  return told;
}

using Told = std::vector<std::string>;

TEST(Waiting, AllOfASequenceAreLoopsAsSoonAsItIsLongEnough) {
  Waiting waiting(few_views());
  for (int i = 0; i < 3; ++i) {
    add(waiting, 50 + i, 10 + i);
    EXPECT_TRUE(waiting.settle(50 + i).empty()) << i;
  }
  add(waiting, 52, 40);
  add(waiting, 53, 13);
  EXPECT_EQ(told(waiting.settle(53)),
            (Told{"50-10 LOOP", "51-11 LOOP", "52-12 LOOP", "53-13 LOOP"}));
  add(waiting, 54, 14);
  EXPECT_EQ(told(waiting.settle(54)), Told{"54-14 LOOP"}) << "and whoever goes on, at once";
  EXPECT_EQ(told(waiting.settle_all()), Told{"52-40 NOT"});
}

TEST(Waiting, WhoWaitsInVainIsRefusedAndTold) {
  Waiting waiting(few_views());
  add(waiting, 50, 10);
  add(waiting, 51, 11);
  EXPECT_TRUE(waiting.settle(55).empty());
  const auto rows = waiting.settle(56);
  EXPECT_EQ(told(rows), Told{"50-10 NOT"});
  EXPECT_EQ(core::stage_of(rows.at(0).verdict), "sequence");
  EXPECT_EQ(core::reason_of(rows.at(0).verdict), "only 2 views in a row go on to match, 4 needed");
}

TEST(Waiting, WhoWasForetoldHangsOnASequenceButProvesNothingOfIt) {
  Waiting waiting(few_views());
  for (int i = 0; i < 3; ++i) add(waiting, 50 + i, 10 + i);
  add(waiting, 53, 13, true);
  add(waiting, 54, 14, true);
  EXPECT_TRUE(waiting.settle(54).empty()) << "three and two that were looked for on purpose";
  add(waiting, 55, 15);
  EXPECT_EQ(told(waiting.settle(55)), (Told{"50-10 LOOP", "51-11 LOOP", "52-12 LOOP", "53-13 LOOP",
                                            "54-14 LOOP", "55-15 LOOP"}))
      << "a fourth nobody looked for, over the gap";
  add(waiting, 57, 35, true);
  waiting.settle(57);
  EXPECT_EQ(told(waiting.settle_all()), Told{"57-35 NOT"}) << "hangs on nothing";
}

TEST(Waiting, NorDoesWhoWasFoundByHisFeatures) {
  Waiting waiting(few_views());
  for (int i = 0; i < 3; ++i) add(waiting, 50 + i, 10 + i);
  add(waiting, 53, 13, false, true);
  EXPECT_TRUE(waiting.settle(53).empty()) << "three that look alike";
  add(waiting, 54, 14);
  EXPECT_EQ(told(waiting.settle(54)),
            (Told{"50-10 LOOP", "51-11 LOOP", "52-12 LOOP", "53-13 LOOP", "54-14 LOOP"}));
}

TEST(Waiting, AskedForLaterAnEarlierViewTakesItsPlace) {
  Waiting waiting(few_views());
  for (const int i : {1, 2, 3, 0}) add(waiting, 50 + i, 10 + i);
  EXPECT_EQ(waiting.settle(53).size(), 4u);
}

TEST(Waiting, ForetellsHowASequenceGoesOnAndHowItBeganOnce) {
  Waiting waiting(few_views());
  add(waiting, 50, 10);
  EXPECT_TRUE(waiting.foretold(51).empty()) << "one view says nothing";
  add(waiting, 51, 11);
  const std::vector<ViewPair> pairs = waiting.foretold(52);
  ASSERT_GE(pairs.size(), 2u);
  EXPECT_EQ(pairs[0], (ViewPair{52, 12}));
  EXPECT_NE(std::find(pairs.begin(), pairs.end(), ViewPair{49, 9}), pairs.end());
  EXPECT_TRUE(waiting.foretold(52).empty()) << "all named already";
}

TEST(Waiting, ALongSequenceIsNotAskedForItsBeginningForEver) {
  Waiting waiting(few_views());
  std::set<ViewPair> named;
  for (int i = 0; i < 60; ++i) {
    add(waiting, 100 + i, 10 + i);
    for (const ViewPair& pair : waiting.foretold(100 + i))
      EXPECT_TRUE(named.insert(pair).second) << pair.query << " " << pair.match;
    waiting.settle(100 + i);
  }
}

TEST(Waiting, NobodyWaitsLongerThanHeMay) {
  Config config = few_views();
  config.min_views = config.max_pending_views + 1;
  EXPECT_NO_THROW(Waiting{config});
  ++config.min_views;
  EXPECT_THROW(Waiting{config}, core::InputError);
}

TEST(Waiting, ForetellsBackwardsWhereAWalkIsSeenTheOtherWayRound) {
  Waiting waiting(few_views());
  add(waiting, 50, 11);
  add(waiting, 51, 10);
  EXPECT_EQ(waiting.foretold(52).at(0), (ViewPair{52, 9}));
}

}  // namespace
}  // namespace samewhere::verify
