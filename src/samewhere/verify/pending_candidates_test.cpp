#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/verify/pending_candidates.hpp>

namespace samewhere::verify {
namespace {

Config few_views() {
  Config config;
  config.prior = Prior::kUnique;
  config.require_pose = false;
  config.min_views = 4;
  config.max_pending_views = 6;
  return config;
}

// Views of a camera without depth: frame and view have one number.
void add(PendingCandidates& pending, int query, int match,
         core::Origin origin = core::Origin::kRetrieved) {
  core::Evidence evidence{.similarity = 0.8};
  evidence.geometry =
      core::GeometryEvidence{.num_matches = 100, .num_inliers = 30, .spread_ratio = 0.05};
  evidence.sequence = core::SequenceEvidence{.query_view = query, .match_view = match};
  pending.add({.id = core::CandidateId(static_cast<std::uint64_t>(1000 * query + match)),
               .query = core::FrameId(static_cast<std::uint64_t>(query)),
               .match = core::FrameId(static_cast<std::uint64_t>(match)),
               .similarity = 0.8,
               .origin = origin},
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

TEST(PendingCandidates, WithLookAlikePlacesALongSequenceStaysAmbiguous) {
  Config config = few_views();
  config.prior = Prior::kRepetitive;
  PendingCandidates pending(config);
  for (int i = 0; i < 4; ++i) add(pending, 50 + i, 10 + i);
  const auto rows = pending.settle(53);
  ASSERT_EQ(rows.size(), 4U) << "it is decided, nothing is pending";
  for (const auto& row : rows) {
    EXPECT_EQ(core::name_of(row.verdict), "AMBIGUOUS");
    EXPECT_EQ(core::stage_of(row.verdict), "evidence");
  }
  EXPECT_TRUE(pending.settle_all().empty());
}

TEST(PendingCandidates, AllOfASequenceAreAcceptedOnceItIsLongEnough) {
  PendingCandidates pending(few_views());
  for (int i = 0; i < 3; ++i) {
    add(pending, 50 + i, 10 + i);
    EXPECT_TRUE(pending.settle(50 + i).empty()) << i;
  }
  add(pending, 52, 40);
  add(pending, 53, 13);
  EXPECT_EQ(told(pending.settle(53)),
            (Told{"50-10 LOOP", "51-11 LOOP", "52-12 LOOP", "53-13 LOOP"}));
  add(pending, 54, 14);
  EXPECT_EQ(told(pending.settle(54)), Told{"54-14 LOOP"}) << "and its continuation, at once";
  EXPECT_EQ(told(pending.settle_all()), Told{"52-40 NOT"});
}

TEST(PendingCandidates, ACandidateWithoutASequenceIsRejectedInTheEnd) {
  PendingCandidates pending(few_views());
  add(pending, 50, 10);
  add(pending, 51, 11);
  EXPECT_TRUE(pending.settle(55).empty());
  const auto rows = pending.settle(56);
  EXPECT_EQ(told(rows), Told{"50-10 NOT"});
  EXPECT_EQ(core::stage_of(rows.at(0).verdict), "sequence");
  EXPECT_EQ(core::reason_of(rows.at(0).verdict),
            "only 2 consecutive views match, 4 needed, or 40 inliers");
}

TEST(PendingCandidates, PredictedCandidatesDoNotLengthenASequence) {
  PendingCandidates pending(few_views());
  for (int i = 0; i < 3; ++i) add(pending, 50 + i, 10 + i);
  add(pending, 53, 13, core::Origin::kPredicted);
  add(pending, 54, 14, core::Origin::kPredicted);
  EXPECT_TRUE(pending.settle(54).empty()) << "three, and two that were predicted";
  add(pending, 55, 15);
  EXPECT_EQ(told(pending.settle(55)), (Told{"50-10 LOOP", "51-11 LOOP", "52-12 LOOP", "53-13 LOOP",
                                            "54-14 LOOP", "55-15 LOOP"}))
      << "a fourth that was retrieved, over the gap";
  add(pending, 57, 35, core::Origin::kPredicted);
  pending.settle(57);
  EXPECT_EQ(told(pending.settle_all()), Told{"57-35 NOT"}) << "no sequence";
}

TEST(PendingCandidates, NorDoCandidatesByVisualWords) {
  PendingCandidates pending(few_views());
  for (int i = 0; i < 3; ++i) add(pending, 50 + i, 10 + i);
  add(pending, 53, 13, core::Origin::kVisualWords);
  EXPECT_TRUE(pending.settle(53).empty()) << "three that were retrieved";
  add(pending, 54, 14);
  EXPECT_EQ(told(pending.settle(54)),
            (Told{"50-10 LOOP", "51-11 LOOP", "52-12 LOOP", "53-13 LOOP", "54-14 LOOP"}));
}

TEST(PendingCandidates, AnEarlierViewThatComesLaterTakesItsPlace) {
  PendingCandidates pending(few_views());
  for (const int i : {1, 2, 3, 0}) add(pending, 50 + i, 10 + i);
  EXPECT_EQ(pending.settle(53).size(), 4u);
}

TEST(PendingCandidates, PredictsBothEndsOfASequenceOnce) {
  PendingCandidates pending(few_views());
  add(pending, 50, 10);
  EXPECT_TRUE(pending.predict(51).empty()) << "one view is no sequence";
  add(pending, 51, 11);
  const std::vector<ViewPair> pairs = pending.predict(52);
  ASSERT_GE(pairs.size(), 2u);
  EXPECT_EQ(pairs[0], (ViewPair{52, 12}));
  EXPECT_NE(std::find(pairs.begin(), pairs.end(), ViewPair{49, 9}), pairs.end());
  EXPECT_TRUE(pending.predict(52).empty()) << "each pair once";
}

TEST(PendingCandidates, TheBeginningOfALongSequenceIsPredictedOnce) {
  PendingCandidates pending(few_views());
  std::set<ViewPair> named;
  for (int i = 0; i < 60; ++i) {
    add(pending, 100 + i, 10 + i);
    for (const ViewPair& pair : pending.predict(100 + i))
      EXPECT_TRUE(named.insert(pair).second) << pair.query << " " << pair.match;
    pending.settle(100 + i);
  }
}

TEST(PendingCandidates, MinViewsFitIntoMaxPendingViews) {
  Config config = few_views();
  config.min_views = config.max_pending_views + 1;
  EXPECT_NO_THROW(PendingCandidates{config});
  ++config.min_views;
  EXPECT_THROW(PendingCandidates{config}, core::InputError);
}

TEST(PendingCandidates, PredictsBackwardsInTheOppositeDirection) {
  PendingCandidates pending(few_views());
  add(pending, 50, 11);
  add(pending, 51, 10);
  EXPECT_EQ(pending.predict(52).at(0), (ViewPair{52, 9}));
}

}  // namespace
}  // namespace samewhere::verify
