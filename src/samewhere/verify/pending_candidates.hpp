#pragma once

#include <map>
#include <set>
#include <vector>

#include <samewhere/core/ledger.hpp>
#include <samewhere/verify/config.hpp>
#include <samewhere/verify/sequence.hpp>

namespace samewhere::verify {

// Candidates that pass all checks of their own and are pending until the views around them decide.
class PendingCandidates {
 public:
  // Throws InputError if a candidate is given up before a sequence of min_views can be seen.
  explicit PendingCandidates(const Config& config);

  // evidence.sequence has the numbers of both views.
  void add(const core::Candidate& candidate, const core::Evidence& evidence);

  // Pairs that would match if the best sequences that reach up to this query view are right: of
  // this view, and of those before a sequence began; the most likely first. Each pair once.
  std::vector<ViewPair> predict(int query_view);

  // Later verdicts on the candidates that can be decided after view `view`, by query: accepted by a
  // sequence that is long enough, or rejected after max_pending_views.
  std::vector<core::LedgerRow> settle(int view);
  // The input has ended: verdicts on all the rest.
  std::vector<core::LedgerRow> settle_all();

 private:
  struct Pending {
    core::Candidate candidate;
    core::Evidence evidence;
  };

  // Through each retrieved pair of views.
  std::map<ViewPair, Sequence> sequences() const;
  // The longest of these that the pair continues, at either end.
  Sequence supported_by(const ViewPair& predicted,
                        const std::map<ViewPair, Sequence>& longest) const;
  // The pairs not predicted before in which the query view continues an end of a sequence.
  void add_next(const ViewPair& end, int query, int step, std::vector<ViewPair>& pairs);
  std::vector<core::LedgerRow> settle_until(int last_view_rejected);

  Config config_;
  std::vector<Pending> pending_;    // undecided; their query views ascend
  std::map<ViewPair, int> claims_;  // inliers of the best claim of these views
  std::set<ViewPair> predicted_;    // so far
  int first_kept_ = 0;              // query views before are forgotten
};

}  // namespace samewhere::verify
