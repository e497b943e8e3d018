#include <algorithm>
#include <utility>

#include <samewhere/core/errors.hpp>
#include <samewhere/paper/methods/neighbour_graph.hpp>

#ifdef SAMEWHERE_HNSWLIB
#include <hnswlib/hnswlib.h>
#endif

namespace samewhere::paper {

#ifdef SAMEWHERE_HNSWLIB

bool NeighbourGraph::is_built_in() { return true; }

struct NeighbourGraph::Graph {
  Graph(std::size_t length, std::size_t capacity, const Settings& settings)
      : space(length),
        index(&space, capacity, static_cast<std::size_t>(settings.num_links),
              static_cast<std::size_t>(settings.num_inserted_among), settings.seed),
        num_numbers(length) {
    index.setEf(static_cast<std::size_t>(settings.num_searched));
  }

  hnswlib::InnerProductSpace space;
  hnswlib::HierarchicalNSW<float> index;
  std::size_t num_numbers;
};

NeighbourGraph::NeighbourGraph(const Settings& settings) : settings_(settings) {}

void NeighbourGraph::insert(int position, std::span<const float> unit) {
  constexpr std::size_t kFirstCapacity = 1024;
  if (!graph_) graph_ = std::make_unique<Graph>(unit.size(), kFirstCapacity, settings_);
  core::require(unit.size() == graph_->num_numbers, "vectors of a graph are of one length");
  auto& index = graph_->index;
  if (index.cur_element_count == index.max_elements_) index.resizeIndex(2 * index.max_elements_);
  index.addPoint(unit.data(), static_cast<hnswlib::labeltype>(position));
}

std::vector<int> NeighbourGraph::nearest(std::span<const float> unit, int count) const {
  if (!graph_) return {};
  core::require(unit.size() == graph_->num_numbers, "vectors of a graph are of one length");
  auto found = graph_->index.searchKnn(unit.data(), static_cast<std::size_t>(count));
  std::vector<std::pair<float, int>> by_distance;
  for (; !found.empty(); found.pop())
    by_distance.emplace_back(found.top().first, static_cast<int>(found.top().second));
  std::sort(by_distance.begin(), by_distance.end());
  std::vector<int> positions;
  for (const auto& [distance, position] : by_distance) positions.push_back(position);
  return positions;
}

#else

bool NeighbourGraph::is_built_in() { return false; }

struct NeighbourGraph::Graph {};

NeighbourGraph::NeighbourGraph(const Settings& settings) : settings_(settings) {
  throw core::InputError(
      "method \"fild\": this build has no hnswlib; expected the package libhnswlib-dev when it was "
      "built");
}

void NeighbourGraph::insert(int /*position*/, std::span<const float> /*unit*/) {}

std::vector<int> NeighbourGraph::nearest(std::span<const float> /*unit*/, int /*count*/) const {
  return {};
}

#endif

NeighbourGraph::~NeighbourGraph() = default;

}  // namespace samewhere::paper
