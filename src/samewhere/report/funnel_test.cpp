#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/report/funnel.hpp>
#include <samewhere/report/test_record.hpp>

namespace samewhere::report {
namespace {

TEST(Funnel, CountsArrivedAndRejectedCandidatesOfEachCheck) {
  const Funnel found = funnel(sample_ledger());
  EXPECT_EQ(found.num_candidates, 35);
  EXPECT_EQ(found.num_accepted, 3);
  EXPECT_EQ(found.num_ambiguous, 1);
  const std::vector<int> arrived = {35, 15, 15, 9, 5, 5, 5, 5, 4, 4, 3, 3, 3};
  const std::vector<int> ambiguous = {0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0};
  const std::vector<int> rejected = {20, 0, 6, 4, 0, 0, 0, 1, 0, 0, 0, 0, 0};
  std::vector<core::Refusal> checks(std::begin(core::kAllRefusals), std::end(core::kAllRefusals));
  std::erase(checks, core::Refusal::kDeformation);  // of another method
  ASSERT_EQ(found.rows.size(), checks.size());
  ASSERT_EQ(arrived.size(), found.rows.size());
  for (std::size_t i = 0; i < found.rows.size(); ++i) {
    EXPECT_EQ(found.rows[i].stage, checks[i]);
    EXPECT_EQ(found.rows[i].num_arrived, arrived[i]);
    EXPECT_EQ(found.rows[i].num_rejected, rejected[i]);
    EXPECT_EQ(found.rows[i].num_ambiguous, ambiguous[i]);
  }
}

TEST(Funnel, LosesNoCandidate) {
  const Funnel found = funnel(sample_ledger());
  const FunnelRow& last = found.rows.back();
  EXPECT_EQ(last.num_arrived - last.num_rejected - last.num_ambiguous, found.num_accepted);
}

TEST(Funnel, OnlyTheLastVerdictOnACandidateCounts) {
  core::Ledger ledger;
  const core::Candidate asked_twice = candidate(0, 9, 1, 0.8);
  ledger.push_back(ambiguous_row(asked_twice));
  ledger.push_back(ambiguous_row(candidate(1, 9, 2, 0.8)));
  EXPECT_EQ(funnel(ledger).num_ambiguous, 2);
  ledger.push_back(loop_row(asked_twice, 50));
  EXPECT_EQ(funnel(ledger).num_candidates, 2);
  EXPECT_EQ(funnel(ledger).num_ambiguous, 1);
  EXPECT_EQ(funnel(ledger).num_accepted, 1);
  EXPECT_EQ(final_rows(ledger).front(), &ledger.back());
}

TEST(Funnel, OfNothingIsAllZero) {
  const Funnel found = funnel({});
  EXPECT_EQ(found.num_candidates, 0);
  EXPECT_EQ(found.rows.size(), std::size(core::kAllRefusals) - 1) << "one is of another method";
  EXPECT_EQ(found.rows.back().num_arrived, 0);
}

TEST(Funnel, ACandidateWithoutAnIdIsABug) {
  core::Ledger ledger{ambiguous_row({})};
  EXPECT_THROW(funnel(ledger), core::ContractError);
}

TEST(FunnelText, HasEveryCheckAndBothOutcomesInLine) {
  const std::string text = funnel_text(funnel(sample_ledger()));
  std::istringstream lines(text);
  std::vector<std::string> names;
  for (std::string line; std::getline(lines, line);) {
    EXPECT_GE(line.size(), 23u) << line;
    EXPECT_NE(line[22], ' ') << "the second column ends elsewhere: " << line;
    names.push_back(line.substr(2, line.find(' ', 2) - 2));
  }
  EXPECT_EQ(names,
            (std::vector<std::string>{"check", "similarity", "pause", "matches", "inliers",
                                      "spread", "pose", "consistency", "odometry", "competing",
                                      "sequence", "evidence", "graph", "withdrawn", "accepted"}));
  EXPECT_TRUE(text.ends_with("\n"));
}

}  // namespace
}  // namespace samewhere::report
