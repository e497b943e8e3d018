#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace samewhere::paper {

// Unit vectors in a hierarchical navigable small-world graph (Malkov and Yashunin, TPAMI 2020),
// built as they come. By hnswlib, where the build has it.
class NeighbourGraph {
 public:
  static bool is_built_in();

  // Links of a vector, vectors that are looked at when one is inserted, and when one is searched.
  // Throws InputError in a build without hnswlib.
  struct Settings {
    int num_links = 16;
    int num_inserted_among = 200;
    int num_searched = 50;
    std::uint64_t seed = 0;
  };
  explicit NeighbourGraph(const Settings& settings);
  ~NeighbourGraph();
  NeighbourGraph(const NeighbourGraph&) = delete;
  NeighbourGraph& operator=(const NeighbourGraph&) = delete;

  // All of one length. `position` is given back by the search.
  void insert(int position, std::span<const float> unit);
  // The nearest by cosine, nearest first, of equals the older one; fewer if there are fewer.
  std::vector<int> nearest(std::span<const float> unit, int count) const;

 private:
  struct Graph;
  Settings settings_;
  std::unique_ptr<Graph> graph_;  // from the first vector on
};

}  // namespace samewhere::paper
