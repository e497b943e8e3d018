#include <algorithm>

#include <samewhere/verify/sequence.hpp>

namespace samewhere::verify {
namespace {

Sequence continued(const Sequence& sequence, const Claim& claim, int step) {
  const bool begins = sequence.num_views == 0;
  return {.num_views = sequence.num_views + 1,
          .num_inliers = sequence.num_inliers + claim.num_inliers,
          .step = step,
          .first = begins ? claim.views : sequence.first,
          .last = claim.views};
}

// Of each claim the longest sequence that ends with it.
std::vector<Sequence> until(const std::vector<Claim>& claims, int step, int max_gap) {
  std::vector<Sequence> best(claims.size());
  std::size_t first = 0;  // that may be gone on from
  for (std::size_t i = 0; i < claims.size(); ++i) {
    while (claims[i].views.query - claims[first].views.query > max_gap) ++first;
    Sequence before;
    for (std::size_t j = first; j < i; ++j) {
      if (is_longer(best[j], before) && goes_on(claims[j].views, claims[i].views, step, max_gap))
        before = best[j];
    }
    best[i] = continued(before, claims[i], step);
  }
  return best;
}

ViewPair mirrored(const ViewPair& views) { return {-views.query, -views.match}; }

// Of each claim the longest sequence that begins with it: seen in a mirror, it ends there.
std::vector<Sequence> from(std::vector<Claim> claims, int step, int max_gap) {
  std::reverse(claims.begin(), claims.end());
  for (Claim& claim : claims) claim.views = mirrored(claim.views);
  std::vector<Sequence> sequences = until(claims, step, max_gap);
  std::reverse(sequences.begin(), sequences.end());
  return sequences;
}

}  // namespace

bool goes_on(const ViewPair& from, const ViewPair& to, int step, int max_gap) {
  const int query_gap = to.query - from.query;
  const int match_gap = step * (to.match - from.match);
  return query_gap >= 1 && query_gap <= max_gap && match_gap >= 1 && match_gap <= max_gap;
}

bool is_longer(const Sequence& a, const Sequence& b) {
  return a.num_views != b.num_views ? a.num_views > b.num_views : a.num_inliers > b.num_inliers;
}

std::vector<Sequence> longest_sequences(const std::vector<Claim>& claims, int max_gap) {
  std::vector<Sequence> longest(claims.size());
  for (const int step : {1, -1}) {
    const std::vector<Sequence> before = until(claims, step, max_gap);
    const std::vector<Sequence> after = from(claims, step, max_gap);
    for (std::size_t i = 0; i < claims.size(); ++i) {
      Sequence whole = before[i];
      whole.num_views += after[i].num_views - 1;
      whole.num_inliers += after[i].num_inliers - claims[i].num_inliers;
      whole.last = mirrored(after[i].first);
      if (is_longer(whole, longest[i])) longest[i] = whole;
    }
  }
  return longest;
}

}  // namespace samewhere::verify
