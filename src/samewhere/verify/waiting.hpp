#pragma once

#include <map>
#include <set>
#include <vector>

#include <samewhere/core/ledger.hpp>
#include <samewhere/verify/config.hpp>
#include <samewhere/verify/sequence.hpp>

namespace samewhere::verify {

// Candidates whose own evidence is good, and who wait for what the views around them say.
class Waiting {
 public:
  // Throws InputError if who waits could not live to see a sequence of min_views.
  explicit Waiting(const Config& config);

  // evidence.sequence knows the views.
  void add(const core::Candidate& candidate, const core::Evidence& evidence);

  // What else should match if the best sequences that reach up to this query view are any: this
  // view, and those before a sequence began, the likeliest first. Nothing is named twice.
  std::vector<ViewPair> foretold(int query_view);

  // Further verdicts on those that can be decided now that view `view` was seen, by query: a
  // sequence long enough holds them, or they have waited for max_pending_views in vain.
  std::vector<core::LedgerRow> settle(int view);
  // Nothing comes any more.
  std::vector<core::LedgerRow> settle_all();

 private:
  struct Waiter {
    core::Candidate candidate;
    core::Evidence evidence;
  };

  // Of every pair of views that somebody found.
  std::map<ViewPair, Sequence> sequences() const;
  // The longest of these that a pair goes on from, or that goes on from it.
  Sequence held_by(const ViewPair& foretold, const std::map<ViewPair, Sequence>& longest) const;
  // The pairs not named yet in which the query view would go on from an end of a sequence.
  void add_next(const ViewPair& end, int query, int step, std::vector<ViewPair>& pairs);
  std::vector<core::LedgerRow> settle_until(int last_view_given_up);

  Config config_;
  std::vector<Waiter> waiters_;     // undecided; their query views ascend
  std::map<ViewPair, int> claims_;  // inliers of the best claim of these views
  std::set<ViewPair> foretold_;     // so far
  int first_kept_ = 0;              // query views before are forgotten
};

}  // namespace samewhere::verify
