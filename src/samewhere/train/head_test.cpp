#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/core/similarity.hpp>
#include <samewhere/input/test_folder.hpp>
#include <samewhere/network/inference.hpp>
#include <samewhere/train/autoencoder.hpp>
#include <samewhere/train/head_onnx.hpp>
#include <samewhere/train/head_training.hpp>

namespace samewhere::train {
namespace {

constexpr MapShape kShape{70, 4, 6};

std::vector<float> random_maps(int num_views, std::uint64_t seed) {
  core::Random random(seed);
  std::vector<float> maps(static_cast<std::size_t>(num_views * kShape.size()));
  for (float& number : maps) number = static_cast<float>(std::max(0.0, random.gaussian()));
  return maps;
}

HeadConfig small_head() {
  return {
      .epochs = 3, .batch = 6, .learning_rate = 1e-3, .code_size = 12, .clusters = 5, .threads = 1};
}

constexpr HeadKind kAllKinds[] = {HeadKind::kGem, HeadKind::kNetvlad, HeadKind::kDarknet};

// Three places, seen in turn for ten rounds; a place has a pattern of its own beside a stronger one
// that changes from view to view.
HeadSource walk_of_three_places(std::uint64_t seed) {
  constexpr int kNumViews = 30;
  HeadSource walk{.name = "walk", .shape = kShape, .frames_per_view = 150};
  walk.places.num_frames = kNumViews;
  const std::vector<float> places = random_maps(3, 1);
  const std::vector<float> changes = random_maps(kNumViews, seed);
  const auto length = static_cast<std::size_t>(kShape.size());
  for (int view = 0; view < kNumViews; ++view) {
    cv::Mat map(1, kShape.size(), CV_32F);
    for (std::size_t i = 0; i < length; ++i) {
      map.at<float>(static_cast<int>(i)) =
          0.6F * places[static_cast<std::size_t>(view % 3) * length + i] +
          changes[static_cast<std::size_t>(view) * length + i];
    }
    cv::Mat half;
    map.convertTo(half, CV_16F);
    walk.maps.push_back(half);
    for (int other = 0; other < kNumViews; ++other) {
      walk.places.values.push_back(view % 3 == other % 3 ? core::PlaceTruth::kSame
                                                         : core::PlaceTruth::kDifferent);
    }
  }
  walk.aliased_pairs = {{4, 0}, {5, 1}};
  return walk;
}

TEST(Head, ExportsWhatItHasLearntOfAllKinds) {
  set_num_threads(1);
  for (const HeadKind kind : kAllKinds) {
    HeadNetwork head(kind, kShape, small_head());
    head.initialize(random_maps(20, 2));
    const std::vector<float> maps = random_maps(3, 3);
    const std::vector<float> wanted = head.codes(maps);
    const auto exported = network::make_inference(
        network::parse_network("exported", head_onnx_bytes(head.weights())));
    for (int view = 0; view < 3; ++view) {
      const int shape[] = {1, kShape.channels, kShape.rows, kShape.columns};
      cv::Mat map(4, shape, CV_32F);
      std::copy_n(maps.begin() + view * kShape.size(), kShape.size(), map.ptr<float>());
      const std::vector<float> code = exported->run(map);
      ASSERT_EQ(code.size(), 12U);
      for (std::size_t i = 0; i < code.size(); ++i) {
        EXPECT_NEAR(code[i], wanted[static_cast<std::size_t>(view) * 12 + i], 1e-3)
            << "kind " << static_cast<int>(kind);
      }
    }
  }
}

// The formulas of the two papers, the slow way.
TEST(Head, PoolsAsGemSays) {
  HeadNetwork head(HeadKind::kGem, kShape, small_head());
  head.initialize(random_maps(20, 2));
  const HeadWeights weights = head.weights();
  EXPECT_FLOAT_EQ(weights.power, 3.0F);
  const std::vector<float> maps = random_maps(1, 3);
  const int num_positions = kShape.rows * kShape.columns;
  std::vector<double> pooled;
  for (int channel = 0; channel < kShape.channels; ++channel) {
    double sum = 0.0;
    for (int i = 0; i < num_positions; ++i)
      sum += std::pow(maps[static_cast<std::size_t>(channel * num_positions + i)], 3.0);
    pooled.push_back(std::cbrt(sum / num_positions));
  }
  const std::vector<float> code = head.codes(maps);
  for (std::size_t row = 0; row < code.size(); ++row) {
    double sum = weights.project_biases[row];
    for (std::size_t i = 0; i < pooled.size(); ++i)
      sum += weights.project_weights[row * pooled.size() + i] * pooled[i];
    EXPECT_NEAR(code[row], sum, 1e-3);
  }
}

TEST(Head, LossFallsAndTheSameCallsGiveTheSameWeights) {
  set_num_threads(1);
  const std::vector<HeadSource> sources{walk_of_three_places(5)};
  const std::vector<HeadSource> validation{walk_of_three_places(6)};
  for (const HeadKind kind : {HeadKind::kGem, HeadKind::kDarknet}) {
    HeadConfig config = small_head();
    config.epochs = 25;
    const TrainedHead trained =
        train_head(kind, sources, validation, config, [](const HeadEpoch&) { return true; });
    EXPECT_EQ(trained.history.size(), 26U);
    EXPECT_LT(trained.history.back().loss, trained.history[1].loss);
    const TrainedHead again =
        train_head(kind, sources, validation, config, [](const HeadEpoch&) { return true; });
    EXPECT_EQ(again.weights.project_weights, trained.weights.project_weights);
  }
}

TEST(Head, StopsWhenItIsTold) {
  const TrainedHead trained =
      train_head(HeadKind::kGem, {walk_of_three_places(5)}, {}, small_head(),
                 [](const HeadEpoch& epoch) { return epoch.epoch < 1; });
  EXPECT_EQ(trained.history.size(), 2U);
}

TEST(HeadSource, SingleImagesAreTheSameByTheirImageOnly) {
  HeadSource source{.shape = kShape, .views_per_image = 2};
  EXPECT_EQ(relation_of(source, 4, 4), Relation::kIgnored);
  EXPECT_EQ(relation_of(source, 4, 5), Relation::kSame);
  EXPECT_EQ(relation_of(source, 5, 6), Relation::kIgnored);     // the next image
  EXPECT_EQ(relation_of(source, 5, 26), Relation::kDifferent);  // eleven images on
}

TEST(HeadSource, AWalksViewsAreRelatedByItsPlaces) {
  HeadSource walk = walk_of_three_places(5);
  walk.places.values[1] = core::PlaceTruth::kNear;
  EXPECT_EQ(relation_of(walk, 0, 1), Relation::kIgnored);
  EXPECT_EQ(relation_of(walk, 0, 2), Relation::kDifferent);
  EXPECT_EQ(relation_of(walk, 0, 3), Relation::kSame);
}

TEST(HeadSource, TheAucOfAPerfectCodeIsOne) {
  const HeadSource walk = walk_of_three_places(5);
  std::vector<std::vector<float>> codes;
  for (int view = 0; view < walk.num_views(); ++view) {
    std::vector<float> code(3, 0.0F);
    code[static_cast<std::size_t>(view % 3)] = 1.0F;
    codes.push_back(code);
  }
  EXPECT_NEAR(auc_of_walk(walk, codes), 1.0, 1e-9);
}

TEST(Head, AMapThatHasNoFourEqualPartsIsRefused) {
  EXPECT_THAT(input::complaint([] {
                HeadNetwork(HeadKind::kDarknet, MapShape{8, 5, 4}, small_head());
              }),
              testing::HasSubstr("5 x 4 positions"));
}

}  // namespace
}  // namespace samewhere::train
