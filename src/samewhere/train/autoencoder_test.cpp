#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/input/test_folder.hpp>
#include <samewhere/train/autoencoder.hpp>
#include <samewhere/train/network_file.hpp>
#include <samewhere/train/test_images.hpp>

namespace samewhere::train {
namespace {

Batch batch_of(const ImageSet& images, const Config& config, std::uint64_t seed) {
  std::vector<int> all;
  for (int i = 0; i < static_cast<int>(images.views.size()); ++i) all.push_back(i);
  return make_batch(images.views, all, seed, config);
}

TEST(NetworkPlan, ACodeThatNoLayerGivesIsRefused) {
  const auto refused = input::complaint([] { plan_network({.code_size = 1000}); });
  EXPECT_THAT(refused, testing::HasSubstr("code_size = 1000"));
  EXPECT_THAT(refused, testing::HasSubstr("798 or 1064"));
}

// For all sizes of input: the length of the code is the planned one, and OpenCV, reading the
// exported file, gives the trained network's code to 1e-5 of its largest number.
TEST(Autoencoder, ExportsWhatItHasLearnt) {
  set_num_threads(1);
  const ImageSet images = test_images(4);
  for (const InputSize size : {InputSize::k120x160, InputSize::k180x240, InputSize::k360x480}) {
    SCOPED_TRACE(static_cast<int>(size));
    const Config config{.input_size = size, .code_size = 532, .channels = 6};
    Autoencoder autoencoder(plan_network(config), 1);
    // the statistics of the normalisation leave their first values
    for (std::uint64_t i = 0; i < 5; ++i) autoencoder.learn(batch_of(images, config, i), 1e-2);
    const cv::Mat input = encoder_input(images.views[0], size);
    EXPECT_EQ(autoencoder.encode({input.ptr<float>(), input.total()}).size(), 532U);
    const double error = export_error(autoencoder, images, config);
    EXPECT_LT(error, 1e-5);
    EXPECT_GT(error, 0.0) << "two different implementations were compared";
  }
}

TEST(Autoencoder, LearnsAndRestoredGoesOnWithTheSameBits) {
  set_num_threads(1);
  const ImageSet images = test_images(6);
  const Config config = test_config();
  const NetworkPlan plan = plan_network(config);
  const Batch batch = batch_of(images, config, 3);
  Autoencoder first(plan, 1);
  const double before = first.error(batch);
  for (int i = 0; i < 20; ++i) first.learn(batch, 1e-2);
  EXPECT_LT(first.error(batch), 0.8 * before);

  Autoencoder second(plan, 2);
  EXPECT_NE(second.error(batch), first.error(batch));
  second.restore(first.state());
  for (int i = 0; i < 3; ++i) EXPECT_EQ(first.learn(batch, 1e-3), second.learn(batch, 1e-3));
  EXPECT_EQ(parameters_of(first.encoder()), parameters_of(second.encoder()));
  EXPECT_EQ(first.error(batch), second.error(batch));
}

TEST(Autoencoder, TheStateOfAnotherNetworkIsRefused) {
  Autoencoder small(plan_network(test_config()), 1);
  Config other = test_config();
  other.channels = 3;
  Autoencoder large(plan_network(other), 1);
  EXPECT_NE(input::complaint([&] { small.restore(large.state()); }), "no error");
  EXPECT_NE(input::complaint([&] { small.restore("no state"); }), "no error");
}

}  // namespace
}  // namespace samewhere::train
