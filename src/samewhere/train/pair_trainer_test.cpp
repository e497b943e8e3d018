#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/input/test_folder.hpp>
#include <samewhere/train/autoencoder.hpp>
#include <samewhere/train/pair_network_file.hpp>
#include <samewhere/train/sha256.hpp>
#include <samewhere/train/test_pairs.hpp>
#include <samewhere/verify/pair_network.hpp>

namespace samewhere::train {
namespace {

using input::complaint;
using testing::HasSubstr;

void run_epochs(PairTrainer& trainer, int num_epochs) {
  for (int i = 0; i < num_epochs; ++i) ASSERT_TRUE(trainer.run_epoch([](int, int) {}));
}

class PairTraining : public testing::Test {
 protected:
  PairTraining() { set_num_threads(1); }

  std::filesystem::path path(const std::string& name) const { return folder_.at(name); }

  input::TestFolder folder_;
  PairSet set_ = test_pairs(24);
};

TEST_F(PairTraining, TellsPairsOfOnePlaceFromOthers) {
  PairConfig config = test_pair_config();
  config.epochs = 12;
  const PairJob job{.sources = {"pictures"}, .out = path("small.onnx"), .config = config};
  PairTrainer trainer(config, set_, checkpoint_of(job.out), "abc");
  run_epochs(trainer, 12);
  EXPECT_LT(trainer.best_epoch().validation_error, 0.5);  // a guess has ln 2; libraries differ
  const PairQuality quality = write_pair_network(job, set_, trainer);
  EXPECT_GT(quality.separation.auc, 0.98);
  EXPECT_EQ(quality.separation.num_true, 12);
}

TEST_F(PairTraining, StoppedAfterTwoEpochsAndResumedIsTheSameToTheLastBit) {
  PairTrainer whole(test_pair_config(), set_, path("whole"), "abc");
  run_epochs(whole, 4);
  {
    PairTrainer first(test_pair_config(), set_, path("parts"), "abc");
    run_epochs(first, 2);
  }
  PairTrainer second(test_pair_config(), set_, path("parts"), "abc");
  ASSERT_EQ(second.history().size(), 2U);
  run_epochs(second, 2);
  EXPECT_TRUE(second.is_done());
  EXPECT_EQ(parameters_of(whole.classifier().network().convolutions),
            parameters_of(second.classifier().network().convolutions));
  EXPECT_EQ(whole.history()[3].validation_error, second.history()[3].validation_error);
}

TEST_F(PairTraining, GoesOnWithTheSameSettingsAndPairsOnly) {
  {
    PairTrainer first(test_pair_config(), set_, path("checkpoint"), "abc");
    run_epochs(first, 1);
  }
  PairConfig other = test_pair_config();
  other.hidden_pictures = 0.5;
  EXPECT_THAT(complaint([&] { PairTrainer(other, set_, path("checkpoint"), "abc"); }),
              HasSubstr("hidden_pictures: 0.5"));
  PairSet others = set_;
  others.sha256 = "of others";
  EXPECT_THAT(
      complaint([&] { PairTrainer(test_pair_config(), others, path("checkpoint"), "abc"); }),
      HasSubstr("give the same sources"));
}

// In use, from the file, the network answers as it did when it was trained.
TEST_F(PairTraining, LeavesANetworkThatIsUsedAsItWasTrainedAndItsCard) {
  const PairJob job{.sources = {"pictures"},
                    .validate = {"other pictures"},
                    .out = path("small.onnx"),
                    .config = test_pair_config(),
                    .command = "samewhere train pairs"};
  PairTrainer trainer(job.config, set_, checkpoint_of(job.out), "abc");
  run_epochs(trainer, 4);
  write_pair_network(job, set_, trainer);
  EXPECT_FALSE(std::filesystem::exists(checkpoint_of(job.out)));
  const auto card = nlohmann::json::parse(core::read_file(card_of(job.out)));
  EXPECT_EQ(card["sha256"], sha256_of(core::read_file(job.out)));
  EXPECT_EQ(card["pairs"]["sources"][0]["num_same"], 24);
  EXPECT_EQ(card["pairs"]["num_validation"], 24);
  EXPECT_EQ(card["settings"]["channels"], "2");
  EXPECT_EQ(card["epochs"].size(), 4U);

  verify::PairNetwork network("pairs", job.out.string());
  const std::vector<cv::Mat> planes = trainer.checked_planes();
  ASSERT_EQ(planes.size(), 16U);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    EXPECT_NEAR(network.probability_of_same({.planes = planes[i]}), trainer.best_answers()[i], 1e-5)
        << "pair " << i;
  }
}

TEST_F(PairTraining, WithoutPicturesItIsBlindToThem) {
  PairConfig config = test_pair_config();
  config.hidden_pictures = 1.0;
  PairTrainer trainer(config, set_, path("checkpoint"), "abc");
  run_epochs(trainer, 2);
  cv::Mat planes = trainer.checked_planes().front();
  const auto judge = [&] {
    return trainer.classifier().judge({planes.ptr<float>(), planes.total()}).front();
  };
  const float before = judge();
  planes.rowRange(0, 2 * verify::kPairSide_px).setTo(0.3F);
  EXPECT_EQ(judge(), before);
  planes.rowRange(2 * verify::kPairSide_px, 4 * verify::kPairSide_px).setTo(0.3F);
  EXPECT_NE(judge(), before);
}

TEST_F(PairTraining, ARuinedNetworkIsNotWritten) {
  PairConfig config = test_pair_config();
  const PairJob job{.out = path("ruined.onnx"), .config = config};
  PairTrainer trainer(config, set_, checkpoint_of(job.out), "abc");
  run_epochs(trainer, 1);
  Checkpoint changed = read_checkpoint(checkpoint_of(job.out));
  const Checkpoint good = changed;
  changed.best_parameters[0] += 0.5F;
  write_checkpoint(checkpoint_of(job.out), changed);
  EXPECT_THROW(
      write_pair_network(job, set_, PairTrainer(config, set_, checkpoint_of(job.out), "abc")),
      core::ContractError);
  changed = good;
  changed.best_codes.assign(changed.best_codes.size(), 0.5F);
  write_checkpoint(checkpoint_of(job.out), changed);
  EXPECT_THAT(complaint([&] {
                write_pair_network(job, set_,
                                   PairTrainer(config, set_, checkpoint_of(job.out), "abc"));
              }),
              HasSubstr("the same to all pairs"));
  EXPECT_FALSE(std::filesystem::exists(job.out));
}

}  // namespace
}  // namespace samewhere::train
