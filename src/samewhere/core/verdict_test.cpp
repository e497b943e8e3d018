#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/verdict.hpp>

namespace samewhere::core {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(Verdict, EveryRefusalHasANameOfItsOwn) {
  std::set<std::string_view> names;
  for (const Refusal refusal : kAllRefusals) names.insert(name_of(refusal));
  EXPECT_EQ(names.size(), std::size(kAllRefusals));
}

TEST(Verdict, ANoNamesItsStageAndItsReason) {
  Rejection rejection;
  rejection.candidate = CandidateId(4);
  rejection.evidence.similarity = 0.7;
  rejection.stage = Refusal::kInliers;
  rejection.reason = "9 inliers, 15 needed";
  const Verdict verdict = rejection;
  EXPECT_EQ(name_of(verdict), "NOT");
  EXPECT_EQ(stage_of(verdict), "inliers");
  EXPECT_EQ(reason_of(verdict), "9 inliers, 15 needed");
  EXPECT_EQ(evidence_of(verdict).similarity, 0.7);
  EXPECT_FALSE(is_loop(verdict));
}

TEST(Verdict, AMaybeIsNeitherALoopNorANo) {
  Ambiguous ambiguous;
  ambiguous.candidate = CandidateId(5);
  ambiguous.reason = "two places fit";
  const Verdict verdict = ambiguous;
  EXPECT_EQ(name_of(verdict), "AMBIGUOUS");
  EXPECT_EQ(stage_of(verdict), "sequence");
  EXPECT_EQ(reason_of(verdict), "two places fit");
  EXPECT_FALSE(is_loop(verdict));
}

TEST(Verdict, ALoopSaysWhatItRestsOn) {
  LoopClosure loop;
  loop.candidate = CandidateId(6);
  loop.evidence.similarity = 0.912;
  EXPECT_EQ(reason_of(Verdict(loop)), "similarity 0.912") << "nothing but appearance was measured";
  GeometryEvidence& geometry = loop.evidence.geometry.emplace();
  geometry.num_matches = 80;
  geometry.num_inliers = 62;
  geometry.reprojection_rmse_px = 1.3;
  EXPECT_EQ(name_of(Verdict(loop)), "LOOP");
  EXPECT_EQ(stage_of(Verdict(loop)), "accepted");
  EXPECT_THAT(reason_of(Verdict(loop)), AllOf(HasSubstr("62 inliers"), HasSubstr("1.30 px")));
}

}  // namespace
}  // namespace samewhere::core
