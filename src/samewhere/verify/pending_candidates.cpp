#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/verify/decide.hpp>
#include <samewhere/verify/pending_candidates.hpp>

namespace samewhere::verify {
namespace {

constexpr int kMaxPredicted = 4;  // or a few more

// Other origins were proposed because they fit, which is no evidence for a sequence.
bool is_claim(const core::Candidate& candidate) {
  return candidate.origin == core::Origin::kRetrieved;
}

ViewPair views_of(const core::Evidence& evidence) {
  return {evidence.sequence->query_view, evidence.sequence->match_view};
}

}  // namespace

PendingCandidates::PendingCandidates(const Config& config) : config_(config) {
  if (config.min_views > config.max_pending_views + 1) {
    throw core::InputError(
        fmt::format("verify.min_views is {}; expected at most {}, since candidates are pending for "
                    "verify.max_pending_views {}",
                    config.min_views, config.max_pending_views + 1, config.max_pending_views));
  }
}

void PendingCandidates::add(const core::Candidate& candidate, const core::Evidence& evidence) {
  core::require(evidence.geometry && evidence.sequence, "a pending candidate was measured");
  const ViewPair views = views_of(evidence);
  const auto later = std::upper_bound(pending_.begin(), pending_.end(), views.query,
                                      [](int view, const Pending& pending) {
                                        return view < pending.evidence.sequence->query_view;
                                      });
  pending_.insert(later, {candidate, evidence});
  if (!is_claim(candidate)) return;
  int& num_inliers = claims_[views];
  num_inliers = std::max(num_inliers, evidence.geometry->num_inliers);
}

std::vector<ViewPair> PendingCandidates::predict(int query_view) {
  std::vector<Sequence> near;
  for (const auto& [views, sequence] : sequences()) {
    if (sequence.num_views > 1 && sequence.last.query >= query_view - config_.max_view_gap)
      near.push_back(sequence);
  }
  std::stable_sort(near.begin(), near.end(), is_longer);
  std::vector<ViewPair> pairs;
  for (const Sequence& sequence : near) {
    if (sequence.last.query < query_view) add_next(sequence.last, query_view, sequence.step, pairs);
    for (int gap = 1; gap <= config_.max_view_gap; ++gap)
      add_next(sequence.first, sequence.first.query - gap, sequence.step, pairs);
    if (static_cast<int>(pairs.size()) >= kMaxPredicted) break;
  }
  return pairs;
}

void PendingCandidates::add_next(const ViewPair& end, int query, int step,
                                 std::vector<ViewPair>& pairs) {
  if (query < first_kept_) return;
  const int direction = query > end.query ? 1 : -1;
  const int query_gap = direction * (query - end.query);
  for (const int match_gap : {query_gap, query_gap + 1, query_gap - 1}) {
    const ViewPair pair{query, end.match + direction * step * match_gap};
    if (match_gap < 1 || match_gap > config_.max_view_gap) continue;
    if (predicted_.insert(pair).second) pairs.push_back(pair);
  }
}

std::vector<core::LedgerRow> PendingCandidates::settle(int view) {
  std::vector<core::LedgerRow> rows = settle_until(view - config_.max_pending_views);
  // a pending candidate may depend on what came max_pending_views before it
  first_kept_ = std::max(first_kept_, view - 2 * config_.max_pending_views);
  const ViewPair first{first_kept_, std::numeric_limits<int>::min()};
  claims_.erase(claims_.begin(), claims_.lower_bound(first));
  predicted_.erase(predicted_.begin(), predicted_.lower_bound(first));
  return rows;
}

std::vector<core::LedgerRow> PendingCandidates::settle_all() {
  return settle_until(std::numeric_limits<int>::max());
}

std::map<ViewPair, Sequence> PendingCandidates::sequences() const {
  std::vector<Claim> claims;
  for (const auto& [views, num_inliers] : claims_) claims.push_back({views, num_inliers});
  const std::vector<Sequence> longest = longest_sequences(claims, config_.max_view_gap);
  std::map<ViewPair, Sequence> sequences;
  for (std::size_t i = 0; i < claims.size(); ++i) sequences[claims[i].views] = longest[i];
  return sequences;
}

Sequence PendingCandidates::supported_by(const ViewPair& predicted,
                                         const std::map<ViewPair, Sequence>& longest) const {
  const int gap = config_.max_view_gap;
  constexpr int kAny = std::numeric_limits<int>::min();
  Sequence best;
  const auto end = longest.lower_bound({predicted.query + gap + 1, kAny});
  for (auto it = longest.lower_bound({predicted.query - gap, kAny}); it != end; ++it) {
    const auto& [other, sequence] = *it;
    const bool is_next = goes_on(predicted, other, sequence.step, gap) ||
                         goes_on(other, predicted, sequence.step, gap);
    if (is_next && is_longer(sequence, best)) best = sequence;
  }
  return best;
}

std::vector<core::LedgerRow> PendingCandidates::settle_until(int last_view_rejected) {
  std::vector<core::LedgerRow> rows;
  if (pending_.empty()) return rows;
  const std::map<ViewPair, Sequence> longest = sequences();
  std::vector<Pending> undecided;
  for (Pending& pending : pending_) {
    core::SequenceEvidence& evidence = *pending.evidence.sequence;
    const ViewPair views = views_of(pending.evidence);
    const Sequence sequence =
        is_claim(pending.candidate) ? longest.at(views) : supported_by(views, longest);
    evidence.num_views = sequence.num_views;
    evidence.num_inliers = sequence.num_inliers;
    evidence.is_over = evidence.query_view <= last_view_rejected;
    core::Verdict verdict = decide(pending.candidate, pending.evidence, {}, config_);
    if (is_pending(verdict))
      undecided.push_back(pending);
    else
      rows.push_back({pending.candidate, std::move(verdict)});
  }
  pending_ = std::move(undecided);
  return rows;
}

}  // namespace samewhere::verify
