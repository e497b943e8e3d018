#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <samewhere/core/rig.hpp>
#include <samewhere/core/truth.hpp>
#include <samewhere/twin/truth/sight.hpp>

namespace samewhere::twin {

inline constexpr int kDark = -1;

// Where a camera went, and which state of the building it saw at each frame.
struct Walk {
  core::Trajectory poses;
  std::vector<int> visit_of_frame;  // one per pose: index of the visit; kDark: nothing is seen
};

// Where one frame was taken: the area that holds the camera, else the nearest.
struct FrameTruth {
  int visit = kDark;
  std::string room;  // Area::name; empty if the building has no areas
  int floor = 0;
  int unit = -1;  // index; -1 if the building has no areas
};

// Two frames, at least 10 s apart, of the same place (pr-v2).
struct TrueLoop {
  int query = 0;  // frames of the walk; query > match
  int match = 0;
  double overlap = 0.0;  // the smaller of both ways
  // A person could tell that it is this place and no other: overlap at least 0.5 both ways and a
  // unique object (UniqueObjects) shown by both.
  bool is_confirmable = false;
  std::string object;  // the name of that object, the one shown best; empty if there is none
};

// Two frames of different places (pr-v2) that look the same by construction: with the camera moved
// from its unit to another one of the same kind, the query would be the same place as the match.
struct AliasedPair {
  int query = 0;  // frames of the walk; query > match
  int match = 0;
  double alike = 0.0;  // share of the one's surface that the other sees alike, smaller of both ways
};

// What is true about a walk. The matrices are over its frames, row = query, column = match.
struct WalkTruth {
  std::vector<FrameTruth> frames;
  // Share of the query's surface that the match sees, 255 = all; empty if the walk is long.
  std::vector<std::uint8_t> overlap;
  std::optional<core::PlaceTruthMatrix> places;  // nothing if the walk is long
  std::vector<TrueLoop> loops;                   // ascend by query, then match
  std::vector<AliasedPair> aliased_pairs;        // ascend by query, then match
  // Of every how many frames loops and aliased pairs tell: 1, or 15 in a long walk. Numbers of
  // frames are always those of the whole walk.
  int stride_frames = 1;
};

// Longer walks are long: a matrix over all their frames would be too large.
inline constexpr int kMaxFramesOfMatrix = 3000;

// Progress: pairs of frames that are labelled, of all; an exception ends the work.
using WatchPairs = std::function<void(int num_labelled, int num_pairs)>;

// The truth of a walk from the exact geometry of the building (docs/evaluation.md, pr-v2; Eye):
// same place: overlap at least 0.3 both ways and viewing directions within 45 degrees; different:
// overlap below 0.05 both ways; near: the rest. A dark frame shows no place: it is different from
// all, itself included; its room is looked up in the last visit before it. All visits must number
// their units alike. Of a walk of more than kMaxFramesOfMatrix frames there are no matrices, and
// loops and aliased pairs are sought among every 15th frame only.
WalkTruth truth_of(const Walk& walk, const std::vector<Visit>& visits, const core::Camera& camera,
                   const WatchPairs& watch = nullptr);

// Frames one after another that all are queries of true loops, of which at least one is
// confirmable: ascending. `loops` as in WalkTruth, of every frame.
std::vector<core::FrameSpan> revisits_of(const std::vector<TrueLoop>& loops);

// What the rest of the system compares with. Without aliased pairs and revisits if the walk is
// long: to name a part of them would make others look like none.
core::Truth core_truth(core::Trajectory poses, const WalkTruth& truth);

}  // namespace samewhere::twin
