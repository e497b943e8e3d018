#include <algorithm>
#include <limits>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/input/test_folder.hpp>
#include <samewhere/train/autoencoder.hpp>
#include <samewhere/train/network_file.hpp>
#include <samewhere/train/onnx_file.hpp>
#include <samewhere/train/test_images.hpp>

namespace samewhere::train {
namespace {

Batch batch_of(const ImageSet& images, const Config& config, std::uint64_t seed) {
  std::vector<int> all;
  for (int i = 0; i < static_cast<int>(images.views.size()); ++i) all.push_back(i);
  return ExampleMaker(config, images, {.training = all, .validation = {}},
                      scale_of_targets(images.views, all, config.target))
      .batch(all, seed);
}

std::unique_ptr<network::Inference> exported(const Autoencoder& autoencoder) {
  return network::make_inference(
      network::parse_network("exported", onnx_bytes(autoencoder.encoder(), "")));
}

TEST(NetworkPlan, ACodeThatNoLayerGivesIsRefused) {
  const auto refused = input::complaint([] { plan_network({.code_size = 1000}); });
  EXPECT_THAT(refused, testing::HasSubstr("code_size = 1000"));
  EXPECT_THAT(refused, testing::HasSubstr("984 or 1008"));
}

// For all sizes of input: the length of the code is the planned one, and OpenCV, reading the
// exported file, gives the trained network's code to 1e-5 of its largest number.
TEST(Autoencoder, ExportsWhatItHasLearnt) {
  set_num_threads(1);
  const ImageSet images = test_images(4);
  for (const InputSize size : {InputSize::k120x160, InputSize::k180x240, InputSize::k360x480}) {
    SCOPED_TRACE(static_cast<int>(size));
    const Config config{.input_size = size, .code_size = 528, .channels = 6};
    Autoencoder autoencoder(plan_network(config), 1);
    // the statistics of the normalisation leave their first values
    for (std::uint64_t i = 0; i < 5; ++i) autoencoder.learn(batch_of(images, config, i), 1e-2);
    const cv::Mat input = encoder_input(images.views[0], size);
    const std::vector<float> code = autoencoder.encode({input.ptr<float>(), input.total()});
    EXPECT_EQ(code.size(), 528U);
    const double error = export_error(*exported(autoencoder), {&input, 1}, code);
    EXPECT_LT(error, 1e-5);
    EXPECT_GT(error, 0.0) << "two different implementations were compared";
  }
}

TEST(Autoencoder, AnExportThatDiffersOrIsNoNumberShows) {
  set_num_threads(1);
  const cv::Mat input = encoder_input(test_picture(1), InputSize::k120x160);
  Autoencoder autoencoder(plan_network(test_config()), 1);
  const auto inference = exported(autoencoder);
  std::vector<float> code = autoencoder.encode({input.ptr<float>(), input.total()});
  ASSERT_LT(export_error(*inference, {&input, 1}, code), 1e-5);
  const auto [least, most] = std::minmax_element(code.begin(), code.end());
  code[7] += 1e-3F * std::max(*most, -*least);
  EXPECT_NEAR(export_error(*inference, {&input, 1}, code), 1e-3, 1e-5);
  code[7] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(export_error(*inference, {&input, 1}, code) <= 1e-5);
  std::fill(code.begin(), code.end(), 0.0F);
  EXPECT_FALSE(export_error(*inference, {&input, 1}, code) <= 1e-5);
}

TEST(Autoencoder, LearnsAndRestoredGoesOnWithTheSameBits) {
  set_num_threads(1);
  const ImageSet images = test_images(6);
  const Config config = test_config();
  const NetworkPlan plan = plan_network(config);
  const Batch batch = batch_of(images, config, 3);
  Autoencoder first(plan, 1);
  const double before = first.learn(batch, 1e-2);
  EXPECT_NEAR(before, 1.0, 0.01) << "nothing learnt, nothing known";
  for (int i = 0; i < 20; ++i) first.learn(batch, 1e-2);
  EXPECT_LT(first.learn(batch, 1e-2), 0.5);

  Autoencoder second(plan, 2);
  EXPECT_NE(second.error(batch), first.error(batch));
  second.restore(first.state());
  for (int i = 0; i < 3; ++i) EXPECT_EQ(first.learn(batch, 1e-3), second.learn(batch, 1e-3));
  EXPECT_EQ(parameters_of(first.encoder().convolutions),
            parameters_of(second.encoder().convolutions));
  EXPECT_EQ(first.error(batch), second.error(batch));
}

// Five sources of one picture each: all of other places.
ImageSet places_apart() {
  ImageSet images = test_images(5);
  images.sources.assign(5, {"picture", 1});
  return images;
}

// Targets that are all alike teach nothing: what is learnt, the pairs have taught.
TEST(ContrastiveLoss, DrivesCodesOfOtherPlacesApart) {
  set_num_threads(1);
  const ImageSet images = places_apart();
  const Config config = test_config();
  Autoencoder autoencoder(plan_network(config), 1, {.weight = 1.0, .temperature = 0.07});
  const auto learn = [&](std::uint64_t seed) {
    Batch batch = batch_of(images, config, seed);
    batch.targets.assign(batch.targets.size(), 0.0F);
    return autoencoder.learn(batch, 3e-3);
  };
  double first = 0.0;
  double last = 0.0;
  for (std::uint64_t i = 0; i < 60; ++i) {
    const double loss = learn(i);
    if (i < 10) first += loss;
    if (i >= 50) last += loss;
  }
  EXPECT_LT(last, first / 2.0);
}

TEST(ContrastiveLoss, IsNothingWherePlacesMayBeTheSame) {
  set_num_threads(1);
  const Config config = test_config();
  Batch batch = batch_of(test_images(5), config, 1);
  ASSERT_THAT(batch.other_places, testing::Each(0)) << "neighbours in one source";
  Autoencoder with(plan_network(config), 1, {.weight = 1.0, .temperature = 0.07});
  Autoencoder without(plan_network(config), 1);
  EXPECT_NEAR(with.error(batch), without.error(batch), 1e-6);
  batch.other_places.assign(25, 1);
  EXPECT_GT(with.error(batch), without.error(batch) + 0.01);
}

TEST(Autoencoder, BytesThatAreNoStateAreRefused) {
  Autoencoder autoencoder(plan_network(test_config()), 1);
  EXPECT_NE(input::complaint([&] { autoencoder.restore("no state"); }), "no error");
}

}  // namespace
}  // namespace samewhere::train
