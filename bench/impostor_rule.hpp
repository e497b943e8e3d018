#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <samewhere/core/truth.hpp>

namespace samewhere::bench {

// What a frame is to a query.
enum class Offer {
  kTakenOut,  // the query's own place or moment: never on the shortlist
  kRight,     // another view of the right place: on the shortlist, but no impostor
  kImpostor,  // another place
};

// A test of how well other places pass for the query's.
struct ImpostorRule {
  std::string name;
  std::vector<int> queries;  // frames, ascending
  std::function<Offer(int query, int match)> offer;
};

// What is known of the frames of a source, in their order.
struct KnownFrames {
  std::vector<std::string> names;
  std::vector<double> stamps_s;
  core::Truth truth;
};

// The rules that a source's own truth allows; queries are at least `query_step` frames apart:
// * "other places": every frame but those whose place is the same or near (protocol pr-v2, either
//   way round) and those within 10 s of the query;
// * "listed impostors": of the pairs that truth.aliased_pairs names, by either frame, nothing else;
//   only where the truth has such a list.
// Throws InputError if the truth says nothing about places.
std::vector<ImpostorRule> rules_of_truth(const KnownFrames& frames, int query_step);

// Protocol floor-v2, clip-out: `num_queries` of the images that dataset.csv calls queries, drawn by
// a fixed permutation; gallery images are offered unless of the query's own clip; those of another
// floor are impostors. Frames are those of walk.txt, in its order. Throws InputError.
ImpostorRule tower_rule(const std::filesystem::path& folder, int num_queries);

}  // namespace samewhere::bench
