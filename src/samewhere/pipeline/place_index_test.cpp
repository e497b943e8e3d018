#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <samewhere/pipeline/place_index.hpp>
#include <samewhere/pipeline/test_map_context.hpp>

namespace samewhere::pipeline {
namespace {

// A view without features: only its descriptor counts.
features::View featureless_view(std::uint64_t frame) {
  return {.frame = core::FrameId(frame),
          .stamp_s = 0.0,
          .rig = std::make_shared<core::Rig>(),
          .image_size_px = {640, 480},
          .features = std::make_shared<features::Features>()};
}

// Thirty views of three places, ten each; those of the first are most similar to the query, those
// of the last least. The candidates' matches.
std::vector<std::uint64_t> matches_of_places(
    const retrieve::Config& retrieve, const std::function<bool(core::FrameId)>& is_connected) {
  Config config;
  config.retrieve = retrieve;
  config.retrieve.window_frames = 0;
  PlaceIndex index(config);
  cv::RNG random(5);
  cv::Mat picture(480, 640, CV_8UC1);
  random.fill(picture, cv::RNG::UNIFORM, 0, 256);
  cv::resize(picture(cv::Rect(0, 0, 40, 30)), picture, picture.size(), 0, 0, cv::INTER_CUBIC);
  cv::Mat noise(picture.size(), CV_8UC1);
  random.fill(noise, cv::RNG::UNIFORM, 0, 256);
  cv::resize(noise(cv::Rect(0, 0, 40, 30)), noise, noise.size(), 0, 0, cv::INTER_CUBIC);
  for (std::uint64_t frame = 0; frame < 30; ++frame) {
    cv::Mat seen;
    const double share = 0.02 * static_cast<double>(frame);
    cv::addWeighted(picture, 1.0 - share, noise, share, 0.0, seen);
    index.remember(index.describe(core::FrameId(frame), seen), featureless_view(frame));
  }
  TestMap map;
  map.connected = is_connected;
  map.one_place = [](core::FrameId a, core::FrameId b) { return a.index() / 10 == b.index() / 10; };
  std::vector<std::uint64_t> matches;
  const core::Descriptor query = index.describe(core::FrameId(40), picture);
  for (const auto& candidate : index.retrieve(query, featureless_view(40), map))
    matches.push_back(candidate.match.index());
  return matches;
}

TEST(PlaceIndex, CandidatesAreTheBestViewsOfDifferentPlaces) {
  const auto no_match = [](core::FrameId /*match*/) { return false; };
  EXPECT_EQ(matches_of_places({.shortlist = 30}, no_match),
            (std::vector<std::uint64_t>{0, 10, 20}));
  EXPECT_EQ(
      matches_of_places({.num_candidates = 2, .shortlist = 30, .views_per_place = 2}, no_match),
      (std::vector<std::uint64_t>{0, 1, 10, 11}));
  EXPECT_EQ(matches_of_places({.shortlist = 0}, no_match), (std::vector<std::uint64_t>{0, 1, 2}));
}

TEST(PlaceIndex, ConnectedViewsAreNoCandidates) {
  const auto first_place = [](core::FrameId match) { return match.index() < 10; };
  EXPECT_EQ(matches_of_places({.shortlist = 30}, first_place),
            (std::vector<std::uint64_t>{10, 20}));
  EXPECT_TRUE(matches_of_places({.shortlist = 0}, first_place).empty());
}

}  // namespace
}  // namespace samewhere::pipeline
