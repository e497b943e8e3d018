#pragma once

#include <string>
#include <vector>

#include <samewhere/verify/pair_view.hpp>

namespace samewhere::pairs {

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

// Which pairs of a source are taken.
struct PairRule {
  int step = 10;            // every so many frames is a view; of IE Tower: each is
  int query_step = 10;      // of IE Tower: every so many views is asked; elsewhere each is
  int window_frames = 150;  // true and wrong pairs are further apart; of IE Tower: not asked
  int min_matches = 20;     // fewer that agree on a fundamental matrix are no pair
  double other_cameras =
      0.0;  // share of the views that are taken by_another_camera(), to learn from
};

// Of a twin building or a recording with place truth: the true pairs are of the same place, the
// wrong ones of different places (pr-v2). Of IE Tower or some of its floors: its gallery images;
// the true pairs are neighbours up to 2 s apart in the same clip, the wrong ones of two floors. Of
// each kind the 10 whose descriptors (HOG) are most like the query's are measured. Which views
// another camera took, and how, source and frame decide. Throws InputError if the source cannot be
// read or says nothing about places.
LabelledPairs labelled_pairs(const std::string& source, const PairRule& rule);

}  // namespace samewhere::pairs
