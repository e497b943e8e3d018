#include <algorithm>
#include <limits>

#include <samewhere/core/errors.hpp>
#include <samewhere/verify/decide.hpp>
#include <samewhere/verify/waiting.hpp>

namespace samewhere::verify {
namespace {

constexpr int kMaxForetold = 4;  // or a few more

ViewPair views_of(const core::Evidence& evidence) {
  return {evidence.sequence->query_view, evidence.sequence->match_view};
}

}  // namespace

void Waiting::add(const core::Candidate& candidate, const core::Evidence& evidence) {
  core::require(evidence.geometry && evidence.sequence, "who waits was measured");
  const auto later = std::upper_bound(
      waiters_.begin(), waiters_.end(), evidence.sequence->query_view,
      [](int view, const Waiter& waiter) { return view < waiter.evidence.sequence->query_view; });
  waiters_.insert(later, {candidate, evidence});
}

std::vector<ViewPair> Waiting::foretold(int query_view) {
  std::vector<Sequence> near = sequences();
  std::erase_if(near, [&](const Sequence& sequence) {
    return sequence.num_views < 2 || sequence.last.query < query_view - config_.max_view_gap;
  });
  std::stable_sort(near.begin(), near.end(), is_longer);
  std::vector<ViewPair> pairs;
  for (const Sequence& sequence : near) {
    if (sequence.last.query < query_view) add_next(sequence.last, query_view, sequence.step, pairs);
    for (int gap = 1; gap <= config_.max_view_gap; ++gap)
      add_next(sequence.first, sequence.first.query - gap, sequence.step, pairs);
    if (static_cast<int>(pairs.size()) >= kMaxForetold) break;
  }
  return pairs;
}

void Waiting::add_next(const ViewPair& end, int query, int step, std::vector<ViewPair>& pairs) {
  const int direction = query > end.query ? 1 : -1;
  const int query_gap = direction * (query - end.query);
  for (const int match_gap : {query_gap, query_gap + 1, query_gap - 1}) {
    const ViewPair pair{query, end.match + direction * step * match_gap};
    if (match_gap < 1 || match_gap > config_.max_view_gap) continue;
    if (foretold_.insert(pair).second) pairs.push_back(pair);
  }
}

std::vector<core::LedgerRow> Waiting::settle(int view) {
  std::vector<core::LedgerRow> rows = settle_until(view - config_.wait_views);
  // whoever still waits may hang on what came wait_views before it
  const int first_kept = view - 2 * config_.wait_views;
  std::erase_if(waiters_, [&](const Waiter& waiter) {
    return waiter.evidence.sequence->query_view < first_kept;
  });
  std::erase_if(foretold_, [&](const ViewPair& pair) { return pair.query < first_kept; });
  return rows;
}

std::vector<core::LedgerRow> Waiting::settle_all() {
  return settle_until(std::numeric_limits<int>::max());
}

std::vector<Sequence> Waiting::sequences() const {
  std::vector<Claim> claims;
  for (const Waiter& waiter : waiters_) {
    if (!waiter.candidate.is_foretold)
      claims.push_back({views_of(waiter.evidence), waiter.evidence.geometry->num_inliers});
  }
  return longest_sequences(claims, config_.max_view_gap);
}

Sequence Waiting::held_by(const Waiter& foretold, const std::vector<Sequence>& longest) const {
  Sequence best{.num_views = 1, .num_inliers = foretold.evidence.geometry->num_inliers};
  const ViewPair views = views_of(foretold.evidence);
  auto sequence = longest.begin();
  for (const Waiter& waiter : waiters_) {
    if (waiter.candidate.is_foretold) continue;
    const ViewPair other = views_of(waiter.evidence);
    const bool is_next = goes_on(views, other, sequence->step, config_.max_view_gap) ||
                         goes_on(other, views, sequence->step, config_.max_view_gap);
    if (is_next && is_longer(*sequence, best)) best = *sequence;
    ++sequence;
  }
  return best;
}

std::vector<core::LedgerRow> Waiting::settle_until(int last_view_given_up) {
  const std::vector<Sequence> longest = sequences();
  auto next = longest.begin();
  std::vector<core::LedgerRow> rows;
  for (Waiter& waiter : waiters_) {
    core::SequenceEvidence& evidence = *waiter.evidence.sequence;
    const Sequence sequence = waiter.candidate.is_foretold ? held_by(waiter, longest) : *next++;
    if (waiter.is_decided) continue;
    evidence.num_views = sequence.num_views;
    evidence.num_inliers = sequence.num_inliers;
    evidence.is_over = evidence.query_view <= last_view_given_up;
    core::Verdict verdict = decide(waiter.candidate, waiter.evidence, {}, config_);
    if (std::holds_alternative<core::Ambiguous>(verdict)) continue;
    waiter.is_decided = true;
    rows.push_back({waiter.candidate, std::move(verdict)});
  }
  return rows;
}

}  // namespace samewhere::verify
