#include <cstdlib>

#include <gtest/gtest.h>

#include <samewhere/paper/place_truth.hpp>
#include <samewhere/run/open_source.hpp>

namespace samewhere::paper {
namespace {

// The published matrices were made by another program, by the same rule.
TEST(PlacesByDepth, AgreeWithTheMatrixOfARealRecording) {
  const char* data = std::getenv("SAMEWHERE_DATA");
  if (data == nullptr) GTEST_SKIP() << "SAMEWHERE_DATA is not set";
  pipeline::Config config;
  config.source = std::string(data) + "/hololens";
  const auto source = run::open_source(config);
  const core::Truth truth = source->truth();
  const auto places = places_by_depth(*source, truth.trajectory);
  ASSERT_TRUE(places && truth.places);
  ASSERT_EQ(places->num_frames, truth.places->num_frames);
  int num_equal = 0;
  int num_opposite = 0;  // the same place in one of them and another in the other
  for (std::size_t i = 0; i < places->values.size(); ++i) {
    const auto [ours, theirs] = std::pair(places->values[i], truth.places->values[i]);
    if (ours == theirs) ++num_equal;
    if (ours != theirs && ours != core::PlaceTruth::kNear && theirs != core::PlaceTruth::kNear)
      ++num_opposite;
  }
  const auto num_pairs = static_cast<double>(places->values.size());
  EXPECT_GT(num_equal / num_pairs, 0.95);
  EXPECT_LT(num_opposite / num_pairs, 0.001);
}

}  // namespace
}  // namespace samewhere::paper
