#pragma once

#include <string>
#include <vector>

#include <samewhere/verify/pair_view.hpp>

namespace samewhere::bench {

// Two views that geometry takes for one place, and whether they are.
struct LabelledPair {
  int query = 0;  // positions in LabelledPairs::views
  int match = 0;
  bool is_same = false;
  std::vector<features::Match> matches;  // verify::agreeing_matches()
};

struct LabelledPairs {
  std::vector<verify::SeenView> views;
  std::vector<LabelledPair> pairs;
};

// Of every `step`-th frame of a twin building or a recording with place truth; the true pairs are
// of the same place and more than `window_frames` apart, the wrong ones of different places
// (pr-v2). Of the folder of IE Tower: its gallery images; every `step`-th is a query; the true ones
// are its neighbours up to 2 s away in the same clip, the wrong ones of other floors. Of each kind
// the 10 whose descriptors (HOG) are most like the query's are measured, and those kept of which at
// least 20 matches agree on a fundamental matrix. Throws InputError if the source cannot be read or
// says nothing about places.
LabelledPairs labelled_pairs(const std::string& source, int step, int window_frames);

}  // namespace samewhere::bench
