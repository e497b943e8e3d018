#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "commands.hpp"
#include "options.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/program.hpp>
#include <samewhere/pipeline/blind_spot.hpp>
#include <samewhere/pipeline/described_recording.hpp>
#include <samewhere/pipeline/paper_runs.hpp>
#include <samewhere/pipeline/paper_tables.hpp>

namespace samewhere::app {
namespace {

struct PaperCommand {
  std::vector<std::string> sources;
  std::string tables = "2,3";
  std::string describers;
  std::string out;
  int blind_spot_views = 0;
  ConfigOptions config{.profile = "paper", .file = "", .assignments = {}};
};

// What a command has measured so far, on the terminal and in its folder.
class PaperOutput {
 public:
  PaperOutput(const std::string& folder, pipeline::PaperTableNumbers numbers)
      : folder_(folder), numbers_(std::move(numbers)) {
    if (!folder.empty()) core::make_writable_folder(folder_);
  }

  void add(const pipeline::PaperBlock& block) {
    say(pipeline::paper_text(block, numbers_) + "\n");
    blocks_.push_back(block);
    write("searches.csv", pipeline::searches_csv(blocks_));
    write("times.csv", pipeline::times_csv(blocks_));
    write(pipeline::curves_file_name(block), pipeline::curves_svg(block));
  }

  void add(const std::vector<pipeline::BlindSpotPoint>& points, const retrieve::Config& config) {
    say(pipeline::blind_spot_sentence(points, config.num_draws) + "\n");
    write("blind-spot.csv", pipeline::blind_spot_csv(points));
    write("blind-spot.svg", pipeline::blind_spot_svg(points, config));
  }

 private:
  void say(const std::string& text) {
    fmt::print("{}", text);
    std::fflush(stdout);
    text_ += text;
    write("tables.txt", text_);
  }

  void write(const std::string& name, const std::string& content) const {
    if (!folder_.empty()) core::write_file(folder_ / name, content);
  }

  std::filesystem::path folder_;  // empty: nothing is written
  pipeline::PaperTableNumbers numbers_;
  std::vector<pipeline::PaperBlock> blocks_;
  std::string text_;
};

// A config for each source; throws before any work is done if one cannot be used.
std::vector<pipeline::Config> configs_of(const PaperCommand& command,
                                         const pipeline::Config& config) {
  std::vector<pipeline::Config> configs;
  for (const std::string& source : command.sources) {
    configs.push_back(pipeline::with_source(config, source));
    pipeline::require_place_truth(configs.back());
  }
  return configs;
}

// False: interrupted.
bool measure_tables(const pipeline::Config& config,
                    const std::vector<pipeline::NamedDescriber>& describers, PaperOutput& output) {
  const auto recording = pipeline::describe_recording(config, describers);
  if (!recording) return false;
  for (const auto& views : recording->by_describer) {
    const auto block = pipeline::run_paper_plan(*recording, views, config, {});
    if (!block) return false;
    output.add(*block);
  }
  return true;
}

// False: interrupted.
bool measure_blind_spot(const std::vector<pipeline::Config>& configs, int num_views,
                        describe::Describer& describer, PaperOutput& output) {
  const retrieve::Config& search = configs.front().retrieve;
  std::vector<int> num_draws{10, search.num_draws, 70};
  std::sort(num_draws.begin(), num_draws.end());
  num_draws.erase(std::unique(num_draws.begin(), num_draws.end()), num_draws.end());
  const auto pool = pipeline::make_view_pool(configs, describer, num_views);
  if (!pool) return false;
  const auto points = pipeline::measure_blind_spot(*pool, search, num_draws);
  if (points) output.add(*points, search);
  return points.has_value();
}

int execute(const PaperCommand& command) {
  core::catch_interrupts();
  const pipeline::PaperTableNumbers numbers = pipeline::parse_table_numbers(command.tables);
  const pipeline::Config config = load(command.config);
  const auto describers = pipeline::make_describers(command.describers, config);
  const std::vector<pipeline::Config> configs = configs_of(command, config);
  PaperOutput output(command.out, numbers);
  for (const auto& each : configs) {
    if (!measure_tables(each, describers, output)) return core::kInterruptedExit;
  }
  if (command.blind_spot_views == 0) return core::kDone;
  const bool is_done =
      measure_blind_spot(configs, command.blind_spot_views, *describers.front().describer, output);
  return is_done ? core::kDone : core::kInterruptedExit;
}

void add_paper_command(CLI::App& bench, int& exit_code) {
  auto command = std::make_shared<PaperCommand>();
  CLI::App* sub = bench.add_subcommand(
      "paper", "The published method's tables on recordings whose loops are known");
  sub->add_option("SOURCE", command->sources,
                  "recordings and twin: buildings, each with the window of its protocol in frames "
                  "or seconds: kitchen@149, twin:hotel@10s")
      ->required();
  sub->add_option("--tables", command->tables,
                  "2: AUC by number of draws, 3: milliseconds, 6: loops right and wrong")
      ->capture_default_str();
  sub->add_option("--describers", command->describers,
                  "hog and ONNX files, separated by commas: each on the same frames under the same "
                  "searches; without it the one that describe.method names");
  sub->add_option("--blind-spot", command->blind_spot_views,
                  "also how often the search misses the right queue, in stores of up to this many "
                  "views, those of all sources and crops of them, e.g. 10000")
      ->check(CLI::Range(100, 1'000'000));
  sub->add_option(
      "--out", command->out,
      "folder for the figures as CSV and the curves as SVG; without it none is written");
  add_config_options(*sub, command->config);
  sub->footer(
      "Examples:\n"
      "  samewhere bench paper kitchen@149 office@60 --tables 2,3,6 --out tables\n"
      "  samewhere bench paper kitchen@149 --describers hog,autoencoder.onnx");
  sub->callback([command, &exit_code] { exit_code = execute(*command); });
}

}  // namespace

void add_bench_command(CLI::App& app, int& exit_code) {
  CLI::App* sub = app.add_subcommand("bench", "Measure a method on many recordings at once");
  sub->require_subcommand(1);
  sub->footer("Example: samewhere bench paper kitchen@149 (see samewhere bench paper --help)");
  add_paper_command(*sub, exit_code);
}

}  // namespace samewhere::app
