#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/core/similarity.hpp>
#include <samewhere/retrieve/retriever.hpp>

namespace samewhere::retrieve {
namespace {

constexpr std::uint64_t kChecksum = 42;
constexpr std::size_t kLength = 40;

core::Descriptor descriptor_of(std::uint64_t frame, const std::vector<float>& vector) {
  return {core::FrameId(frame), core::unit(vector), kChecksum};
}

// Not negative, as HOG and networks give: unrelated views have a cosine far above 0.
core::Descriptor random_view(core::Random& random, std::uint64_t frame) {
  std::vector<float> vector(kLength);
  for (float& value : vector) value = static_cast<float>(random.uniform());
  return descriptor_of(frame, vector);
}

core::Descriptor seen_again(core::Random& random, const core::Descriptor& view, std::uint64_t frame,
                            double noise) {
  std::vector<float> vector = view.unit;
  for (float& value : vector) value += static_cast<float>(noise * random.gaussian());
  return descriptor_of(frame, vector);
}

Config config_of(Search search, int window_frames) {
  Config config;
  config.search = search;
  config.window_frames = window_frames;
  return config;
}

Retriever filled(const Config& config, std::uint64_t data_seed, int num_views) {
  core::Random random(data_seed);
  Retriever retriever(config, 1);
  for (int i = 0; i < num_views; ++i) {
    retriever.add(random_view(random, static_cast<std::uint64_t>(i)));
  }
  return retriever;
}

std::vector<core::Candidate> candidates_of(const Retriever& retriever,
                                           const core::Descriptor& query) {
  return compare(query, retriever.search(query));
}

std::vector<std::uint64_t> matches(const std::vector<core::Candidate>& candidates) {
  std::vector<std::uint64_t> frames;
  for (const core::Candidate& candidate : candidates) frames.push_back(candidate.match.index());
  return frames;
}

TEST(Retriever, FindsTheViewThatIsSeenAgain) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    core::Random random(seed);
    Config config = config_of(Search::kExact, 20);
    Retriever exact(config, seed);
    config.search = Search::kSampled;
    config.num_draws = 1000;
    Retriever sampled(config, seed);
    core::Descriptor planted;
    for (std::uint64_t i = 0; i < 300; ++i) {
      const core::Descriptor view = random_view(random, i);
      if (i == 123) planted = view;
      exact.add(view);
      sampled.add(view);
    }
    const core::Descriptor again = seen_again(random, planted, 300, 0.01);
    SCOPED_TRACE("seed " + std::to_string(seed));
    for (const auto& candidates : {candidates_of(exact, again), candidates_of(sampled, again)}) {
      ASSERT_EQ(candidates.size(), 3U);
      EXPECT_EQ(candidates[0].query, core::FrameId(300));
      EXPECT_EQ(candidates[0].match, core::FrameId(123));
      EXPECT_FALSE(candidates[0].id.is_valid());
      EXPECT_NEAR(candidates[0].similarity, core::ncc(again.unit, planted.unit), 1e-6);
      EXPECT_GT(candidates[0].similarity, 0.9);
    }
  }
}

TEST(Retriever, CandidatesComeBestFirstAndTheExactOnesAreAnUpperBound) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    core::Random random(seed + 1000);
    const core::Descriptor query = random_view(random, 900);
    const auto exact = candidates_of(filled(config_of(Search::kExact, 100), seed, 850), query);
    const auto sampled = candidates_of(filled(config_of(Search::kSampled, 100), seed, 850), query);
    SCOPED_TRACE("seed " + std::to_string(seed));
    ASSERT_EQ(exact.size(), 3U);
    ASSERT_FALSE(sampled.empty());
    for (const auto& candidates : {exact, sampled}) {
      for (std::size_t i = 1; i < candidates.size(); ++i) {
        EXPECT_GE(candidates[i - 1].similarity, candidates[i].similarity);
      }
    }
    for (std::size_t i = 0; i < sampled.size(); ++i) {
      EXPECT_LE(sampled[i].similarity, exact[i].similarity + 1e-6);
    }
  }
}

TEST(Retriever, ForgottenViewsAreNeverFound) {
  for (const Search search : {Search::kExact, Search::kSampled, Search::kEveryQueue}) {
    Retriever retriever = filled(config_of(search, 0), 3, 100);
    core::Random random(4);
    const core::Descriptor query = random_view(random, 200);
    ASSERT_FALSE(candidates_of(retriever, query).empty());
    retriever.forget();
    EXPECT_EQ(retriever.num_views(), 0);
    EXPECT_TRUE(candidates_of(retriever, query).empty());
    retriever.add(random_view(random, 150));
    for (const std::uint64_t match : matches(candidates_of(retriever, query)))
      EXPECT_EQ(match, 150U);
  }
}

TEST(Retriever, AViewInsideTheWindowIsNeverACandidate) {
  for (const Search search : {Search::kExact, Search::kSampled}) {
    Config config = config_of(search, 30);
    config.num_candidates = 1000;
    config.num_draws = 1000;
    const Retriever retriever = filled(config, 3, 100);
    core::Random random(4);
    for (std::uint64_t frame = 0; frame < 200; frame += 7) {
      for (const std::uint64_t match :
           matches(candidates_of(retriever, random_view(random, frame)))) {
        EXPECT_LT(match + 30, frame);
      }
    }
    EXPECT_TRUE(candidates_of(retriever, random_view(random, 30)).empty());
    EXPECT_THAT(matches(candidates_of(retriever, random_view(random, 31))),
                testing::ElementsAre(0));
  }
}

TEST(Retriever, OfIdenticalViewsTheOlderComesFirst) {
  core::Random random(1);
  const core::Descriptor view = random_view(random, 0);
  for (const Search search : {Search::kExact, Search::kSampled}) {
    Config config = config_of(search, 0);
    config.num_draws = 1000;
    Retriever retriever(config, 1);
    for (std::uint64_t i = 0; i < 50; ++i) retriever.add(descriptor_of(i, view.unit));
    EXPECT_THAT(matches(candidates_of(retriever, descriptor_of(50, view.unit))),
                testing::ElementsAre(0, 1, 2));
  }
}

TEST(Retriever, DrawsDependOnSeedAndQueryFrameOnly) {
  const Config config = config_of(Search::kSampled, 0);
  core::Random random(5);
  const core::Descriptor query = random_view(random, 2000);
  const core::Descriptor other = random_view(random, 1999);
  const Retriever retriever = filled(config, 3, 1500);
  const auto first = matches(candidates_of(retriever, query));
  candidates_of(retriever, other);
  EXPECT_EQ(matches(candidates_of(retriever, query)), first);
  EXPECT_EQ(matches(candidates_of(filled(config, 3, 1500), query)), first);

  Retriever reseeded(config, 2);
  core::Random data(3);
  for (std::uint64_t i = 0; i < 1500; ++i) reseeded.add(random_view(data, i));
  EXPECT_NE(matches(candidates_of(reseeded, query)), first);
}

TEST(Retriever, ExactSearchKnowsNoThresholdAndSampledSearchHasOne) {
  core::Random random(6);
  std::vector<float> vector(kLength);
  for (float& value : vector) value = static_cast<float>(random.gaussian());
  std::vector<float> opposite;
  for (const float value : vector) opposite.push_back(-value);
  Retriever exact(config_of(Search::kExact, 0), 1);
  Retriever sampled(config_of(Search::kSampled, 0), 1);
  exact.add(descriptor_of(0, vector));
  sampled.add(descriptor_of(0, vector));
  const auto candidates = candidates_of(exact, descriptor_of(1, opposite));
  ASSERT_EQ(candidates.size(), 1U);
  EXPECT_NEAR(candidates[0].similarity, -1.0, 1e-6);
  EXPECT_GE(candidates[0].similarity, -1.0);
  EXPECT_TRUE(candidates_of(sampled, descriptor_of(1, opposite)).empty());
}

TEST(Retriever, ABlackViewLooksLikeNothing) {
  const core::Descriptor black = descriptor_of(500, std::vector<float>(kLength, 0.0F));
  const auto candidates = candidates_of(filled(config_of(Search::kExact, 0), 1, 20), black);
  for (const core::Candidate& candidate : candidates) EXPECT_EQ(candidate.similarity, 0.0);
  EXPECT_TRUE(candidates_of(filled(config_of(Search::kSampled, 0), 1, 20), black).empty());
}

TEST(Retriever, RefusesDescriptorsThatDoNotCompare) {
  Retriever retriever = filled(config_of(Search::kExact, 0), 1, 20);
  core::Random random(2);
  const core::Descriptor good = random_view(random, 100);
  core::Descriptor other_describer = good;
  other_describer.describer_checksum = kChecksum + 1;
  core::Descriptor longer = good;
  longer.unit.push_back(0.0F);
  core::Descriptor not_unit = good;
  for (float& value : not_unit.unit) value *= 2.0F;
  core::Descriptor not_a_number = good;
  not_a_number.unit[3] = std::numeric_limits<float>::quiet_NaN();
  core::Descriptor nameless = good;
  nameless.frame = core::FrameId();
  for (const auto& bad : {other_describer, longer, not_unit, not_a_number, nameless}) {
    EXPECT_THROW(retriever.add(bad), core::ContractError);
    EXPECT_THROW(candidates_of(retriever, bad), core::ContractError);
  }
  EXPECT_THROW(retriever.add(random_view(random, 19)), core::ContractError);  // is there already
  EXPECT_EQ(retriever.num_views(), 20);
  EXPECT_EQ(candidates_of(retriever, good).size(), 3U);
}

TEST(Retriever, SettingsThatDoNotFitAreNamed) {
  Config config;
  config.group_size = 95;
  try {
    const Retriever retriever(config, 1);
    FAIL() << "accepted groups of 95 in queues of 10";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("retrieve.group_size = 95"));
  }
}

}  // namespace
}  // namespace samewhere::retrieve
