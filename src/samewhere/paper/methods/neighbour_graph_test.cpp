#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/core/similarity.hpp>
#include <samewhere/paper/methods/neighbour_graph.hpp>

namespace samewhere::paper {
namespace {

constexpr NeighbourGraph::Settings kDense{
    .num_links = 48, .num_inserted_among = 48, .num_searched = 48, .seed = 3};

std::vector<std::vector<float>> random_units(int count) {
  core::Random random(17);
  std::vector<std::vector<float>> units;
  for (int i = 0; i < count; ++i) {
    std::vector<float> numbers(32);
    for (float& number : numbers) number = static_cast<float>(random.gaussian());
    units.push_back(core::unit(numbers));
  }
  return units;
}

int nearest_of_all(const std::vector<std::vector<float>>& units, int num_older) {
  const auto& query = units[static_cast<std::size_t>(num_older)];
  int best = 0;
  double best_cosine = -2.0;
  for (int i = 0; i < num_older; ++i) {
    const auto& other = units[static_cast<std::size_t>(i)];
    const double cosine = std::inner_product(query.begin(), query.end(), other.begin(), 0.0);
    if (cosine > best_cosine) best = i;
    best_cosine = std::max(best_cosine, cosine);
  }
  return best;
}

TEST(NeighbourGraph, FindsNearlyAlwaysWhatAScanFindsAndTheSameEachTime) {
  if (!NeighbourGraph::is_built_in()) GTEST_SKIP() << "built without hnswlib";
  const auto units = random_units(1500);  // the graph grows once
  NeighbourGraph graph(kDense);
  NeighbourGraph again(kDense);
  EXPECT_TRUE(graph.nearest(units[0], 5).empty());
  int num_found = 0;
  for (int i = 0; i < 1500; ++i) {
    const auto& unit = units[static_cast<std::size_t>(i)];
    if (i > 1000) {
      const std::vector<int> nearest = graph.nearest(unit, 5);
      ASSERT_EQ(nearest.size(), 5U);
      EXPECT_EQ(nearest, again.nearest(unit, 5));
      num_found += nearest.front() == nearest_of_all(units, i) ? 1 : 0;
    }
    graph.insert(i, unit);
    again.insert(i, unit);
  }
  EXPECT_GE(num_found, 450) << "of 499";
}

TEST(NeighbourGraph, ABuildWithoutHnswlibNamesThePackage) {
  if (NeighbourGraph::is_built_in()) GTEST_SKIP() << "built with hnswlib";
  EXPECT_THROW(NeighbourGraph{kDense}, core::InputError);
}

}  // namespace
}  // namespace samewhere::paper
