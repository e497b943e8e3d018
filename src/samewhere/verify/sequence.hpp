#pragma once

#include <vector>

#include <samewhere/verify/config.hpp>

namespace samewhere::verify {

// Numbers of two views of a candidate; views are counted by their content (ViewCounter).
struct ViewPair {
  int query = 0;
  int match = 0;

  friend auto operator<=>(const ViewPair&, const ViewPair&) = default;
};

struct Claim {
  ViewPair views;
  int num_inliers = 0;
};

// Claims one after the other, each with another query view and another match view than all the
// rest.
struct Sequence {
  int num_views = 0;
  int num_inliers = 0;  // of all its claims together
  int step = 1;         // -1: match views descend while query views ascend
  ViewPair first;
  ViewPair last;
};

// Has more views, or of as many more inliers.
bool is_longer(const Sequence& a, const Sequence& b);

// Whether the second pair is the next of a sequence with this step.
bool goes_on(const ViewPair& from, const ViewPair& to, int step, int max_gap);

// Of each claim the longest sequence through it, of equally long ones that with the most inliers:
// the next claim has a later query view and a later match view (or, walked the other way round,
// always an earlier one), neither by more than max_gap. One look-alike rarely goes on for long, a
// place that is seen again does; a copy of a whole corridor goes on as well, so this alone proves
// nothing there. Claims ascend in their query views. After Milford and Wyeth, SeqSLAM, ICRA 2012,
// with verified pairs instead of brightness differences.
std::vector<Sequence> longest_sequences(const std::vector<Claim>& claims, int max_gap);

}  // namespace samewhere::verify
