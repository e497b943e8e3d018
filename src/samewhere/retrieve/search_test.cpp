#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/similarity.hpp>
#include <samewhere/retrieve/search.hpp>

namespace samewhere::retrieve {
namespace {

constexpr int kNumSeeds = 50;
constexpr std::size_t kShortLength = 8;  // short vectors: chance cosines above 0.6 are common

std::vector<float> random_unit(core::Random& random) {
  std::vector<float> vector(kShortLength);
  for (float& value : vector) value = static_cast<float>(random.gaussian());
  return core::unit(vector);
}

struct Scene {
  SegmentedStore store{100, 10};
  std::vector<float> query;
};

Scene random_scene(std::uint64_t seed, int num_vectors) {
  core::Random random(seed);
  Scene scene;
  for (int i = 0; i < num_vectors; ++i) {
    scene.store.append(core::FrameId(static_cast<std::uint64_t>(i)), random_unit(random));
  }
  scene.query = random_unit(random);
  return scene;
}

std::vector<ScoredPosition> sample(const Scene& scene, int num_allowed, const Config& config,
                                   std::uint64_t seed) {
  core::Random random(seed);
  return sampled_search(scene.store, {scene.query, num_allowed}, config, random);
}

// What Table 1 would give if every queue were drawn.
std::vector<ScoredPosition> all_queues(const Scene& scene, int num_allowed, std::size_t per_queue) {
  std::vector<ScoredPosition> expected;
  for (int begin = 0; begin < num_allowed; begin += 10) {
    std::vector<ScoredPosition> queue;
    for (int i = begin; i < std::min(begin + 10, num_allowed); ++i) {
      const double cosine = core::cosine(scene.query, scene.store.vector(i));
      if (cosine > 0.6) queue.push_back({i, cosine});
    }
    std::sort(queue.begin(), queue.end(), is_better);
    queue.resize(std::min(queue.size(), per_queue));
    expected.insert(expected.end(), queue.begin(), queue.end());
  }
  return expected;
}

std::vector<int> positions(const std::vector<ScoredPosition>& scored) {
  std::vector<int> sorted;
  for (const ScoredPosition& s : scored) sorted.push_back(s.position);
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

TEST(ExactSearch, ComparesEveryAllowedVectorAndNoOther) {
  const Scene scene = random_scene(1, 137);
  const std::vector<float> centred = core::centred_unit(scene.query);
  const auto scored = exact_search(scene.store, {centred, 120});
  ASSERT_EQ(scored.size(), 120U);
  for (int i = 0; i < 120; ++i) {
    EXPECT_EQ(scored[static_cast<std::size_t>(i)].position, i);
    EXPECT_NEAR(scored[static_cast<std::size_t>(i)].similarity,
                core::ncc(scene.query, scene.store.vector(i)), 1e-5);
  }
  EXPECT_TRUE(exact_search(scene.store, {centred, 0}).empty());
}

TEST(SampledSearch, WithVeryManyDrawsFindsTheBestThreeOfEveryQueue) {
  Config config;
  config.num_draws = 5000;
  for (std::uint64_t seed = 0; seed < kNumSeeds; ++seed) {
    const Scene scene = random_scene(seed, 237);
    const auto found = sample(scene, 215, config, seed);
    EXPECT_EQ(positions(found), positions(all_queues(scene, 215, 3))) << "seed " << seed;
  }
}

TEST(EveryQueueSearch, IsWhatTheSampleTendsTo) {
  for (const PerDraw per_draw : {PerDraw::kTop3, PerDraw::kNearest}) {
    const std::size_t num_kept = per_draw == PerDraw::kTop3 ? 3 : 1;
    Config config;
    config.per_draw = per_draw;
    for (std::uint64_t seed = 0; seed < kNumSeeds; ++seed) {
      const Scene scene = random_scene(seed, 237);
      const auto found = every_queue_search(scene.store, {scene.query, 215}, config);
      EXPECT_EQ(positions(found), positions(all_queues(scene, 215, num_kept))) << "seed " << seed;
      for (const ScoredPosition& each : found) EXPECT_GT(each.similarity, config.min_similarity);
    }
  }
  EXPECT_TRUE(every_queue_search(SegmentedStore(100, 10), {{}, 0}, {}).empty());
}

TEST(SampledSearch, NearestKeepsTheOneNearestOfAQueue) {
  Config config;
  config.num_draws = 5000;
  config.per_draw = PerDraw::kNearest;
  for (std::uint64_t seed = 0; seed < kNumSeeds; ++seed) {
    // on unit vectors the smallest |x - y| is the largest cosine
    const Scene scene = random_scene(seed, 237);
    const auto found = sample(scene, 215, config, seed);
    EXPECT_EQ(positions(found), positions(all_queues(scene, 215, 1))) << "seed " << seed;
  }
}

TEST(SampledSearch, LooksAtNoMoreQueuesThanItDraws) {
  Config config;
  config.min_similarity = -1.0;
  config.per_draw = PerDraw::kNearest;
  for (std::uint64_t seed = 0; seed < kNumSeeds; ++seed) {
    const Scene scene = random_scene(seed, 1000);
    for (const int num_draws : {1, 2, 10, 50}) {
      config.num_draws = num_draws;
      const auto found = sample(scene, 1000, config, seed);
      std::set<int> queues;
      for (const ScoredPosition& s : found) queues.insert(s.position / 10);
      EXPECT_EQ(queues.size(), found.size()) << "seed " << seed;
      EXPECT_LE(found.size(), static_cast<std::size_t>(num_draws)) << "seed " << seed;
    }
  }
}

TEST(SampledSearch, DrawsEveryQueueEquallyOften) {
  Config config;
  config.min_similarity = -1.0;
  config.per_draw = PerDraw::kNearest;
  config.num_draws = 1;
  const Scene scene = random_scene(1, 200);
  std::vector<int> times(20, 0);
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    for (const ScoredPosition& s : sample(scene, 200, config, seed)) ++times[s.position / 10];
  }
  for (const int count : times) EXPECT_NEAR(count, 200, 70);  // five standard deviations
}

TEST(SampledSearch, NeverGivesAPositionThatIsNotAllowedNorOneTwice) {
  Config config;
  config.min_similarity = -1.0;
  config.num_draws = 200;
  for (std::uint64_t seed = 0; seed < kNumSeeds; ++seed) {
    const Scene scene = random_scene(seed, 150);
    const int num_allowed = static_cast<int>(core::Random(seed).index(150));
    auto found = positions(sample(scene, num_allowed, config, seed));
    EXPECT_TRUE(std::adjacent_find(found.begin(), found.end()) == found.end()) << "seed " << seed;
    for (const int position : found) EXPECT_LT(position, num_allowed) << "seed " << seed;
  }
}

TEST(SampledSearch, IsTheSameForTheSameSeedAndAnotherForAnother) {
  const Scene scene = random_scene(1, 1000);
  Config config;
  EXPECT_EQ(sample(scene, 1000, config, 8), sample(scene, 1000, config, 8));
  EXPECT_NE(sample(scene, 1000, config, 8), sample(scene, 1000, config, 9));
}

TEST(SampledSearch, OfAnEmptyStoreFindsNothing) {
  EXPECT_TRUE(sample(random_scene(1, 0), 0, Config{}, 1).empty());
}

TEST(BestPlaces, OfEqualsTheOlderComesFirst) {
  const Scene scene = random_scene(1, 50);
  const auto best = best_places(scene.store, {{30, 0.5}, {9, 0.5}, {40, 0.9}, {20, 0.5}}, Config{});
  EXPECT_THAT(best, testing::ElementsAre(ScoredPosition{40, 0.9}, ScoredPosition{9, 0.5},
                                         ScoredPosition{20, 0.5}));
}

TEST(BestPlaces, NeighboursOfABetterViewAreTheSamePlace) {
  const Scene scene = random_scene(1, 50);
  Config config;
  config.place_frames = 10;
  const std::vector<ScoredPosition> scored{{20, 0.9}, {21, 0.8}, {11, 0.7}, {30, 0.6}, {5, 0.5}};
  EXPECT_THAT(best_places(scene.store, scored, config),
              testing::ElementsAre(ScoredPosition{20, 0.9}, ScoredPosition{30, 0.6},
                                   ScoredPosition{5, 0.5}));
  config.place_frames = 0;
  EXPECT_THAT(positions(best_places(scene.store, scored, config)),
              testing::ElementsAre(11, 20, 21));
}

TEST(BestPlaces, GivesWhatThereIsIfThatIsLess) {
  const Scene scene = random_scene(1, 50);
  EXPECT_EQ(best_places(scene.store, {{4, 0.1}}, Config{}).size(), 1U);
  EXPECT_TRUE(best_places(scene.store, {}, Config{}).empty());
}

}  // namespace
}  // namespace samewhere::retrieve
