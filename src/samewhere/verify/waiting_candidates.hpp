#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <samewhere/core/ledger.hpp>
#include <samewhere/verify/loop_verifier.hpp>
#include <samewhere/verify/map_context.hpp>

namespace samewhere::verify {

// Candidates of earlier keyframes that are no loops because of a competing hypothesis or for want
// of evidence. They are decided again whenever a loop was closed, suspended or withdrawn. One
// becomes a loop if it passes all checks and the loops of the map tell its place from a look-alike;
// it is rejected if the loops of the map contradict it, and may still become a loop after these are
// withdrawn.
class WaitingCandidates {
 public:
  explicit WaitingCandidates(const LoopVerifier& verifier) : verifier_(verifier) {}

  // Rows of one query. Those that wait are kept, with their competitors among the rows.
  void add(const std::vector<core::LedgerRow>& rows);

  int size() const { return static_cast<int>(waiting_.size()); }

  // Verdicts that have changed, of at most `max_asked` candidates: those that have waited longest
  // since they were asked last, once for each change of the map's loops.
  std::vector<core::LedgerRow> ask_again(const MapContext& map, int max_asked);

 private:
  struct Waiting {
    core::LedgerRow row;
    std::optional<core::LedgerRow> competitor;  // that makes it ambiguous
    std::uint64_t asked_at = 0;                 // num_changes_ then
  };

  core::Verdict decided_again(const Waiting& waiting, const MapContext& map) const;
  // Whether the loops of the map have ruled the competitor out.
  bool is_ruled_out(const core::LedgerRow& competitor, const MapContext& map) const;

  LoopVerifier verifier_;
  std::vector<Waiting> waiting_;
  std::vector<core::CandidateId> loops_;  // of the map that was asked last
  std::uint64_t num_changes_ = 0;         // of them
  std::size_t next_ = 0;                  // in waiting_
};

}  // namespace samewhere::verify
