#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
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
#include <samewhere/core/terminal.hpp>
#include <samewhere/paper/blind_spot.hpp>
#include <samewhere/paper/curves.hpp>
#include <samewhere/paper/described_recording.hpp>
#include <samewhere/paper/runs.hpp>
#include <samewhere/paper/tables.hpp>
#include <samewhere/paper/view_pool.hpp>

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
  PaperOutput(const std::string& folder, paper::PaperTableNumbers numbers)
      : folder_(folder), numbers_(std::move(numbers)) {
    if (!folder.empty()) core::make_writable_folder(folder_);
  }

  void add(const paper::PaperBlock& block) {
    say(paper::paper_text(block, numbers_) + "\n");
    blocks_.push_back(block);
    write("searches.csv", paper::searches_csv(blocks_));
    write("times.csv", paper::times_csv(blocks_));
  }

  // The blocks of one recording.
  void add_curves(const std::vector<paper::PaperBlock>& blocks) const {
    const paper::PaperBlock& any = blocks.front();
    write("pr-" + paper::file_stem(any.recording, any.window_frames) + ".svg",
          paper::curves_svg(blocks));
  }

  void add(const std::vector<paper::BlindSpotPoint>& points, const retrieve::Config& config) {
    say(paper::blind_spot_sentence(points, config.num_draws) + "\n");
    write("blind-spot.csv", paper::blind_spot_csv(points));
    write("blind-spot.svg", paper::blind_spot_svg(points, config));
  }

 private:
  void say(const std::string& text) {
    core::print("{}", text);
    std::fflush(stdout);
    text_ += text;
    write("tables.txt", text_);
  }

  void write(const std::string& name, const std::string& content) const {
    if (!folder_.empty()) core::write_file(folder_ / name, content);
  }

  std::filesystem::path folder_;  // empty: nothing is written
  paper::PaperTableNumbers numbers_;
  std::vector<paper::PaperBlock> blocks_;
  std::string text_;
};

std::vector<pipeline::Config> configs_of(const PaperCommand& command,
                                         const pipeline::Config& config) {
  std::vector<pipeline::Config> configs;
  for (const std::string& source : command.sources)
    configs.push_back(paper::with_source(config, source));
  return configs;
}

// The pool for stores of up to this many views, 0: none is wanted.
std::optional<paper::ViewPoolMaker> pool_maker(int num_views,
                                               const std::vector<paper::OpenRecording>& recordings,
                                               describe::Describer& describer) {
  constexpr int kNumQueries = 200;
  if (num_views == 0) return std::nullopt;
  int num_frames = 0;
  for (const auto& recording : recordings) num_frames += recording.num_frames;
  return std::optional<paper::ViewPoolMaker>(
      std::in_place, describer, num_frames,
      paper::PoolSize{.num_stored = num_views, .num_queries = kNumQueries});
}

// False: interrupted.
bool measure_tables(paper::OpenRecording opened,
                    const std::vector<paper::NamedDescriber>& describers,
                    const paper::SeePicture& also_see, PaperOutput& output) {
  const pipeline::Config config = opened.config;
  const auto recording = paper::describe_recording(std::move(opened), describers, also_see);
  if (!recording) return false;
  std::vector<paper::PaperBlock> blocks;
  for (const auto& views : recording->by_describer) {
    const auto block = paper::run_paper_plan(*recording, views, config, {});
    if (!block) return false;
    output.add(*block);
    blocks.push_back(*block);
  }
  output.add_curves(blocks);
  return true;
}

// False: interrupted.
bool measure_blind_spot(const paper::ViewPool& pool, const retrieve::Config& search,
                        PaperOutput& output) {
  std::vector<int> num_draws{10, search.num_draws, 70};
  std::sort(num_draws.begin(), num_draws.end());
  num_draws.erase(std::unique(num_draws.begin(), num_draws.end()), num_draws.end());
  const auto points = paper::measure_blind_spot(pool, search, num_draws);
  if (points) output.add(*points, search);
  return points.has_value();
}

int execute(const PaperCommand& command) {
  core::catch_interrupts();
  const paper::PaperTableNumbers numbers = paper::parse_table_numbers(command.tables);
  const pipeline::Config config = load(command.config);
  const auto describers = paper::make_describers(command.describers, config);
  // all are open, and so known to be of use, before any work is done
  auto recordings = paper::open_recordings(configs_of(command, config));
  auto maker = pool_maker(command.blind_spot_views, recordings, *describers.front().describer);
  const paper::SeePicture to_pool = [&](const cv::Mat& picture) {
    if (maker) maker->add(picture);
  };
  PaperOutput output(command.out, numbers);
  for (auto& recording : recordings) {
    if (!measure_tables(std::move(recording), describers, to_pool, output))
      return core::kInterruptedExit;
  }
  if (!maker) return core::kDone;
  const paper::ViewPool pool = std::move(*maker).pool();
  return measure_blind_spot(pool, config.retrieve, output) ? core::kDone : core::kInterruptedExit;
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
      "folder for the figures as CSV and the curves as SVG, one picture a recording; without it "
      "none is written");
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
