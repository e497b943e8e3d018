#include <gtest/gtest.h>

#include <samewhere/run/run_notes.hpp>

namespace samewhere::run {
namespace {

core::LedgerRow row_of(std::uint64_t candidate, bool is_accepted,
                       core::Origin origin = core::Origin::kRetrieved) {
  core::LedgerRow row;
  row.candidate.id = core::CandidateId(candidate);
  row.candidate.origin = origin;
  if (is_accepted)
    row.verdict = core::LoopClosure{};
  else
    row.verdict = core::Rejection{};
  return row;
}

TEST(LoopCount, CountsAcceptedLoopsUntilTheyAreWithdrawn) {
  LoopCount loops;
  EXPECT_EQ(loops.text(), "0 loops");
  loops.add({row_of(1, true), row_of(2, false), row_of(3, true)});
  loops.add({row_of(1, true)});
  EXPECT_EQ(loops.text(), "2 loops");
  loops.add({row_of(3, false)});
  EXPECT_EQ(loops.text(), "1 loop");
}

TEST(LoopCount, LeavesOutRelocalizations) {
  LoopCount loops;
  loops.add({row_of(1, true, core::Origin::kRelocalization)});
  EXPECT_EQ(loops.text(), "0 loops");
}

}  // namespace
}  // namespace samewhere::run
