#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "commands.hpp"
#include "options.hpp"
#include "start_program.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/terminal.hpp>
#include <samewhere/run/vocabulary_training.hpp>

namespace samewhere::app {
namespace {

struct WordsCommand {
  run::VocabularyTraining training;
  std::string out = "words.bin";
  ConfigOptions config;
};

void train_words(const WordsCommand& command) {
  core::catch_interrupts();
  run::VocabularyTraining training = command.training;
  training.out = command.out;
  if (training.out.extension() == ".json") {
    throw core::InputError("--out = " + command.out +
                           ": reserved for the card; expected another ending, such as .bin");
  }
  core::make_writable_folder(std::filesystem::absolute(training.out).parent_path());
  training.command = "samewhere train words";
  for (const std::string& source : training.sources) training.command += " " + source;
  training.command += fmt::format(" --step {} --branching {} --depth {} --out {}", training.step,
                                  training.grow.branching, training.grow.depth, command.out);
  for (const std::string& assignment : command.config.assignments)
    training.command += " --set " + assignment;
  const run::TrainedVocabulary trained = run::train_vocabulary(training, load(command.config));
  core::print("{} words of {} features in {} pictures: {}\n", trained.num_words,
              trained.num_features, trained.num_pictures, command.out);
}

void add_words_command(CLI::App& train) {
  auto command = std::make_shared<WordsCommand>();
  CLI::App* sub =
      train.add_subcommand("words", "Train a vocabulary of visual words from ORB features");
  sub->set_help_flag("-h,--help", "Print this help message and exit");
  run::VocabularyTraining& training = command->training;
  sub->add_option("SOURCE", training.sources, "recordings, folders or lists of images, twin:PRESET")
      ->required();
  sub->add_option("--out", command->out, "vocabulary file to write, with a card (JSON) beside it")
      ->capture_default_str();
  sub->add_option("--step", training.step, "use every N-th image")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  sub->add_option("--branching", training.grow.branching, "children of a node")
      ->check(CLI::Range(2, 100))
      ->capture_default_str();
  sub->add_option("--depth", training.grow.depth,
                  "levels: at most branching to the power of depth words")
      ->check(CLI::Range(1, 8))
      ->capture_default_str();
  add_config_options(*sub, command->config);
  sub->callback([command] { train_words(*command); });
  sub->footer(
      "Examples:\n"
      "  samewhere train words photos/ --out words.bin\n"
      "  samewhere train words office/ 'twin:hotel?seed=7' --step 5 --out words.bin\n"
      "then: samewhere loops SOURCE --set retrieve.vocabulary=words.bin --set "
      "retrieve.word_candidates=3");
}

}  // namespace

void add_train_command(CLI::App& app) {
  CLI::App* sub = app.add_subcommand(
      "train",
      "Train the network that describes an image; with `words`, a vocabulary of visual words");
  // all that follows is for the training program, --help too; but for the words, which need none
  sub->set_help_flag();
  sub->prefix_command();
  add_words_command(*sub);
  sub->callback([sub] {
    if (!sub->get_subcommands().empty()) return;
    start_program("samewhere-train", sub->remaining(), "train",
                  "`./run train` installs libtorch and builds it");
  });
}

}  // namespace samewhere::app
