#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/run/prior.hpp>

namespace samewhere::run {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

core::LedgerRow uncertain_row(std::uint64_t id, core::FrameId query, core::Origin origin) {
  const core::Candidate candidate{core::CandidateId(id), query, core::FrameId(id), 0.5, origin};
  return {candidate, core::Ambiguous{candidate.id, {}, core::Refusal::kEvidence, "alone"}};
}

TEST(PriorFigure, LoopsAndRelocalizationsAreCountedApart) {
  const core::Ledger ledger = {uncertain_row(0, core::FrameId(90), core::Origin::kRetrieved),
                               uncertain_row(1, core::FrameId(90), core::Origin::kVisualWords),
                               uncertain_row(2, core::FrameId(91), core::Origin::kRelocalization),
                               uncertain_row(3, core::FrameId(91), core::Origin::kRelocalization),
                               uncertain_row(4, core::FrameId(92), core::Origin::kRelocalization)};
  EXPECT_THAT(prior_figure(ledger, {}).numbers, ElementsAre(2.0, 1.0));
  const auto relocalization = relocalization_prior_figure(ledger, {});
  ASSERT_TRUE(relocalization);
  EXPECT_THAT(relocalization->numbers, ElementsAre(3.0, 2.0));
  EXPECT_THAT(relocalization->value, HasSubstr("unique would accept 3 candidates, of 2 frames"));
}

TEST(PriorFigure, WithoutARelocalizationNothingIsSaidOfIt) {
  const core::Ledger ledger = {uncertain_row(0, core::FrameId(90), core::Origin::kRetrieved)};
  EXPECT_FALSE(relocalization_prior_figure(ledger, {}));
}

TEST(PriorFigure, OfUniqueTheLoopsThatAppearanceAloneAccepted) {
  verify::Config unique;
  unique.prior = verify::Prior::kUnique;
  const core::Candidate candidate{core::CandidateId(0), core::FrameId(90), core::FrameId(0), 0.5,
                                  core::Origin::kRelocalization};
  core::LoopClosure loop;
  loop.candidate = candidate.id;
  loop.evidence.similarity = 0.5;
  const auto figure = relocalization_prior_figure({{candidate, loop}}, unique);
  ASSERT_TRUE(figure);
  EXPECT_THAT(figure->value, HasSubstr("repetitive would leave 1 of these"));
}

}  // namespace
}  // namespace samewhere::run
