#include <cmath>
#include <csignal>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/similarity.hpp>
#include <samewhere/describe/describer.hpp>
#include <samewhere/input/image_file.hpp>
#include <samewhere/input/test_folder.hpp>
#include <samewhere/train/network_file.hpp>
#include <samewhere/train/sha256.hpp>
#include <samewhere/train/test_images.hpp>

namespace samewhere::train {
namespace {

using input::complaint;
using testing::HasSubstr;

void run_epochs(Trainer& trainer, int num_epochs) {
  for (int i = 0; i < num_epochs; ++i) ASSERT_TRUE(trainer.run_epoch([](int, int) {}));
}

class Training : public testing::Test {
 protected:
  Training() { set_num_threads(1); }

  std::filesystem::path path(const std::string& name) const { return folder_.at(name); }

  input::TestFolder folder_;
  ImageSet images_ = test_images(24);
};

TEST_F(Training, StoppedAfterTwoEpochsAndResumedIsTheSameToTheLastBit) {
  Trainer whole(test_config(), images_, path("whole"), "abc");
  run_epochs(whole, 4);
  {
    Trainer first(test_config(), images_, path("parts"), "abc");
    run_epochs(first, 2);
  }
  Trainer second(test_config(), images_, path("parts"), "abc");
  ASSERT_EQ(second.history().size(), 2U);
  run_epochs(second, 2);
  EXPECT_TRUE(second.is_done());
  EXPECT_EQ(parameters_of(whole.autoencoder().encoder().convolutions),
            parameters_of(second.autoencoder().encoder().convolutions));
  EXPECT_EQ(parameters_of(whole.best_encoder().convolutions),
            parameters_of(second.best_encoder().convolutions));
  EXPECT_EQ(whole.history()[3].validation_error, second.history()[3].validation_error);
}

TEST_F(Training, GoesOnWithTheSameSettingsAndImagesOnly) {
  {
    Trainer first(test_config(), images_, path("checkpoint"), "abc");
    run_epochs(first, 1);
  }
  Config other = test_config();
  other.batch = 8;
  const auto refused = complaint([&] { Trainer(other, images_, path("checkpoint"), "abc"); });
  EXPECT_THAT(refused, HasSubstr("checkpoint"));
  EXPECT_THAT(refused, HasSubstr("batch: 4"));
  EXPECT_THAT(refused, HasSubstr("batch: 8"));
  ImageSet others = images_;
  others.sha256 = "of others";
  EXPECT_THAT(complaint([&] { Trainer(test_config(), others, path("checkpoint"), "abc"); }),
              HasSubstr("other images"));
  other = test_config();
  other.threads = 2;
  EXPECT_EQ(complaint([&] { Trainer(other, images_, path("checkpoint"), "abc"); }), "no error");
}

TEST_F(Training, EachProgramThatHadAPartIsNamed) {
  for (const std::string commit : {"abc", "abc", "def"}) {
    Trainer trainer(test_config(), images_, path("checkpoint"), commit);
    run_epochs(trainer, 1);
  }
  Trainer trainer(test_config(), images_, path("checkpoint"), "def");
  EXPECT_THAT(trainer.commits(), testing::ElementsAre("abc", "def"));
}

TEST_F(Training, DoesNotGoOnWithAnotherNetwork) {
  {
    Trainer first(test_config(), images_, path("checkpoint"), "abc");
    run_epochs(first, 1);
  }
  Checkpoint other = read_checkpoint(path("checkpoint"));
  other.network = "four layers";
  write_checkpoint(path("checkpoint"), other);
  const auto refused =
      complaint([&] { Trainer(test_config(), images_, path("checkpoint"), "def"); });
  EXPECT_THAT(refused, testing::AllOf(HasSubstr("checkpoint"), HasSubstr("abc"),
                                      HasSubstr("four layers"), HasSubstr("input 120x160")));
}

TEST_F(Training, ADamagedCheckpointIsRefused) {
  {
    Trainer first(test_config(), images_, path("checkpoint"), "abc");
    run_epochs(first, 1);
  }
  folder_.cut("checkpoint", 0.7);
  EXPECT_THAT(complaint([&] { Trainer(test_config(), images_, path("checkpoint"), "abc"); }),
              testing::AllOf(HasSubstr("checkpoint"), HasSubstr("damaged")));
}

// A limit on the size of files stands for a full disk.
TEST_F(Training, OnAFullDiskTheLastCheckpointSurvives) {
  Trainer trainer(test_config(), images_, path("checkpoint"), "abc");
  run_epochs(trainer, 1);
  const std::string last = core::read_file(path("checkpoint"));
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit{};
  getrlimit(RLIMIT_FSIZE, &limit);
  limit.rlim_cur = last.size() / 2;
  setrlimit(RLIMIT_FSIZE, &limit);
  EXPECT_THAT(complaint([&] { trainer.run_epoch([](int, int) {}); }),
              testing::AllOf(HasSubstr("checkpoint"), HasSubstr("cannot be written")));
  EXPECT_TRUE(core::read_file(path("checkpoint")) == last);
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_FSIZE, &limit);
}

TEST_F(Training, EndsWhenValidationGetsNoBetter) {
  Config config = test_config();
  config.epochs = 50;
  config.patience = 2;
  config.learning_rate = 1.0;  // far too much: it jumps about
  Trainer trainer(config, images_, path("checkpoint"), "abc");
  while (!trainer.is_done()) run_epochs(trainer, 1);
  EXPECT_LT(trainer.history().size(), 50U);
  EXPECT_EQ(static_cast<int>(trainer.history().size()), trainer.best_epoch().epoch + 2);
}

// Of one batch an epoch the training loss is the one before the step: only validation sees what the
// step has done.
TEST_F(Training, ARuinedNetworkReachesNeitherCheckpointNorChoice) {
  Config config = test_config();
  config.batch = 1024;
  config.learning_rate = 1e30;
  Trainer trainer(config, images_, path("checkpoint"), "abc");
  EXPECT_THAT(complaint([&] { trainer.run_epoch([](int, int) {}); }),
              testing::AllOf(HasSubstr("learning_rate"), HasSubstr("epoch 1")));
  EXPECT_TRUE(trainer.history().empty());
  EXPECT_FALSE(std::filesystem::exists(path("checkpoint")));
}

TEST_F(Training, LeavesANetworkAndItsCard) {
  const Job job{.images = {"pictures"},
                .out = path("small.onnx"),
                .config = test_config(),
                .command = "samewhere train",
                .version = "0"};
  Trainer trainer(job.config, images_, checkpoint_of(job.out), "abc");
  run_epochs(trainer, 4);
  const Quality quality = write_network(job, images_, trainer);
  EXPECT_FALSE(std::filesystem::exists(checkpoint_of(job.out)));
  EXPECT_EQ(quality.best.epoch, trainer.best_epoch().epoch);

  const std::string network = core::read_file(job.out);
  const auto card = nlohmann::json::parse(core::read_file(card_of(job.out)));
  EXPECT_EQ(card["sha256"], sha256_of(network));
  EXPECT_EQ(card["settings"]["code_size"], "240");
  EXPECT_EQ(card["images"]["sources"][0]["num_images"], 24);
  EXPECT_EQ(card["images"]["validation_sources"], "blocks of the sources");
  EXPECT_EQ(card["epochs"].size(), 4U);
  EXPECT_THAT(card["commits"], testing::ElementsAre("abc"));
  const auto inference = network::make_inference(network::read_network(job.out));
  EXPECT_LE(export_error(*inference, trainer.checked_inputs(), trainer.best_codes()), 1e-5);
}

// From the file of a photo both ways: as a view to learn from, and as a user has it described.
TEST_F(Training, SeesAViewAsTheNetworkSeesItInUse) {
  for (const InputSize size : {InputSize::k120x160, InputSize::k360x480}) {
    Config config = test_config();
    config.input_size = size;
    const Job job{.out = path(fmt::format("{}.onnx", input_size_px(size).width)), .config = config};
    for (int i = 0; i < 6; ++i) {
      cv::Mat coloured;
      cv::cvtColor(test_picture(i, {640, 480}), coloured, cv::COLOR_GRAY2BGR);
      cv::GaussianBlur(coloured, coloured, {}, 1.5);  // as a lens does
      folder_.write_png(fmt::format("photos/{}.png", i), coloured);
    }
    const std::vector<std::string> sources = {path("photos").string()};
    const ImageSet images = read_images(sources, {}, config, [](const std::string&, int, int) {});
    Trainer trainer(config, images, checkpoint_of(job.out), "abc");
    run_epochs(trainer, 1);
    write_network(job, images, trainer);
    const auto describer = describe::make_describer(
        {.method = describe::Method::kAutoencoder, .network = job.out.string()});
    for (int i = 0; i < 6; ++i) {
      const cv::Mat input = encoder_input(images.views[static_cast<std::size_t>(i)], size);
      const auto code = trainer.autoencoder().encode({input.ptr<float>(), input.total()});
      const cv::Mat photo = input::read_image(path(fmt::format("photos/{}.png", i)));
      const auto described = describer->describe(core::FrameId(0), photo);
      EXPECT_GT(core::cosine(described.unit, code), 1.0 - 1e-4) << job.out << ", photo " << i;
    }
  }
}

TEST_F(Training, TheCardNamesTheSourcesToValidateWith) {
  images_.sources = {{"pictures", 20}, {"other pictures", 4, 1, true}};
  const Job job{.out = path("small.onnx"), .config = test_config()};
  Trainer trainer(job.config, images_, checkpoint_of(job.out), "abc");
  run_epochs(trainer, 1);
  write_network(job, images_, trainer);
  const auto card = nlohmann::json::parse(core::read_file(card_of(job.out)));
  EXPECT_EQ(card["images"]["sources"].size(), 1U);
  EXPECT_EQ(card["images"]["validation_sources"][0]["source"], "other pictures");
  EXPECT_EQ(card["images"]["num_training"], 20);
  EXPECT_EQ(card["images"]["num_validation"], 4);
}

TEST_F(Training, AFileOfTheSameNameIsNotOverwritten) {
  EXPECT_EQ(complaint([&] { require_free(path("mine.onnx")); }), "no error");
  for (const std::string name : {"mine.onnx", "mine.json"}) {
    folder_.write(name, "");
    EXPECT_THAT(complaint([&] { require_free(path("mine.onnx")); }),
                testing::AllOf(HasSubstr("--out"), HasSubstr(name + " is there already")));
    if (name == "mine.onnx") std::filesystem::remove(path(name));
  }
  folder_.write("mine.checkpoint", "");
  EXPECT_EQ(complaint([&] { require_free(path("mine.onnx")); }), "no error") << "goes on";
}

// The training goes on past its best epoch, so that network and last network differ.
TEST_F(Training, WritesTheNetworkThatWasBestOrNone) {
  Config config = test_config();
  config.epochs = 20;
  config.patience = 2;
  config.learning_rate = 0.3;  // too much: it jumps about
  const Job job{.images = {"pictures"}, .out = path("jumpy.onnx"), .config = config};
  const auto checkpoint = checkpoint_of(job.out);
  {
    Trainer trainer(config, images_, checkpoint, "abc");
    while (!trainer.is_done()) run_epochs(trainer, 1);
    ASSERT_NE(parameters_of(trainer.best_encoder().convolutions),
              parameters_of(trainer.autoencoder().encoder().convolutions));
  }
  const Checkpoint good = read_checkpoint(checkpoint);
  const auto write_after = [&](const auto& change) {
    Checkpoint changed = good;
    change(changed);
    write_checkpoint(checkpoint, changed);
    Trainer trainer(config, images_, checkpoint, "abc");
    write_network(job, images_, trainer);
  };
  const auto change_biases = [](Checkpoint& c) {  // of the last layer's ten channels
    for (int i = 1; i <= 10; ++i) *(c.best_parameters.end() - i) += 0.1F;
  };
  EXPECT_THROW(write_after(change_biases), core::ContractError);
  EXPECT_THROW(write_after([](Checkpoint& c) { c.best_codes[0] = NAN; }), core::ContractError);
  EXPECT_THAT(
      complaint([&] { write_after([](Checkpoint& c) { c.best_parameters[0] = INFINITY; }); }),
      HasSubstr("not finite"));
  EXPECT_THAT(complaint([&] {
                write_after([](Checkpoint& c) { c.best_codes.assign(c.best_codes.size(), 0.0F); });
              }),
              HasSubstr("zeros"));
  EXPECT_FALSE(std::filesystem::exists(job.out));
  EXPECT_EQ(complaint([&] { write_after([](Checkpoint&) {}); }), "no error");
  EXPECT_TRUE(std::filesystem::exists(job.out));
}

}  // namespace
}  // namespace samewhere::train
