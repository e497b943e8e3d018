#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "commands.hpp"
#include "options.hpp"
#include "start_program.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/program.hpp>
#include <samewhere/core/terminal.hpp>
#include <samewhere/paper/benchmark.hpp>
#include <samewhere/paper/blind_spot.hpp>
#include <samewhere/paper/page.hpp>
#include <samewhere/paper/protocols.hpp>
#include <samewhere/paper/tables.hpp>
#include <samewhere/paper/view_pool.hpp>

namespace samewhere::app {
namespace {

struct PaperCommand {
  std::vector<std::string> sources;
  std::string tables = "2-8";
  std::vector<std::string> methods;
  std::string out = "paper";
  int num_seeds = 5;
  int num_slam_runs = 3;
  bool is_quick = false;
  bool is_fresh = false;
  int blind_spot_views = 0;
  ConfigOptions config{.profile = "paper", .file = "", .assignments = {}};
};

paper::BenchmarkPlan plan_of(const PaperCommand& command) {
  paper::BenchmarkPlan plan{.config = load(command.config),
                            .sources = command.sources,
                            .methods = command.methods,
                            .needs_all_sources = !command.sources.empty(),
                            .needs_all_methods = !command.methods.empty(),
                            .tables = paper::parse_table_numbers(command.tables),
                            .searches = {},
                            .num_slam_runs = command.num_slam_runs};
  if (plan.sources.empty()) {
    const char* const data = std::getenv("SAMEWHERE_DATA");
    plan.sources = command.is_quick ? std::vector{paper::quick_source()}
                                    : paper::default_sources(data ? data : "");
  }
  if (plan.methods.empty()) plan.methods = paper::all_methods();
  plan.searches.num_seeds = command.num_seeds;
  if (!command.is_quick) return plan;
  plan.searches = {.num_draws = {10, 50, 70}, .num_seeds = 2};
  plan.num_slam_runs = 1;
  return plan;
}

// What makes the same results again: all options that bear on a figure.
std::string command_line(const PaperCommand& command) {
  const PaperCommand usual;
  std::string line = "samewhere bench paper";
  const auto add = [&](std::string_view option, const auto& value, const auto& usual_value) {
    if (value != usual_value) line += fmt::format(" {} {}", option, value);
  };
  for (const std::string& source : command.sources) line += fmt::format(" '{}'", source);
  if (command.is_quick) line += " --quick";
  line += " --tables " + command.tables;
  if (!command.methods.empty())
    line += fmt::format(" --methods {}", fmt::join(command.methods, ","));
  add("--seeds", command.num_seeds, usual.num_seeds);
  add("--runs", command.num_slam_runs, usual.num_slam_runs);
  add("--blind-spot", command.blind_spot_views, usual.blind_spot_views);
  add("--profile", command.config.profile, usual.config.profile);
  add("--config", command.config.file, usual.config.file);
  for (const std::string& assignment : command.config.assignments)
    line += fmt::format(" --set {}", assignment);
  return line;
}

// Where images of rendered sequences are kept while the command works, since most of its time would
// go into rendering them again for each method; a place that the user named stays in force. The
// folder has a name that no data set has: it is removed at the end.
class RenderedImages {
 public:
  explicit RenderedImages(const std::filesystem::path& results)
      : folder_(results / ".rendered-by-samewhere") {
    const char* const named = std::getenv(kCache);
    is_own_ = named == nullptr || *named == '\0';
    if (is_own_) setenv(kCache, folder_.c_str(), 1);
  }
  RenderedImages(const RenderedImages&) = delete;
  RenderedImages& operator=(const RenderedImages&) = delete;
  ~RenderedImages() {
    if (!is_own_) return;
    unsetenv(kCache);
    std::error_code ignored;  // what stays is used by the next run
    std::filesystem::remove_all(folder_, ignored);
  }

 private:
  static constexpr const char* kCache = "SAMEWHERE_CACHE";
  std::filesystem::path folder_;
  bool is_own_ = false;
};

// The files of the results folder.
class PaperFolder {
 public:
  PaperFolder(const PaperCommand& command, paper::PaperTableNumbers numbers)
      : folder_(command.out), numbers_(std::move(numbers)), command_(command_line(command)) {}

  void write(const paper::Results& results) const {
    std::string text;
    const auto tables = paper::make_tables(results, numbers_);
    for (const paper::PaperTable& table : tables) text += paper::as_text(table) + "\n";
    core::write_file(folder_ / "tables.txt", text);
    core::write_file(folder_ / "recognition.csv", paper::recognition_csv(results));
    core::write_file(folder_ / "slam.csv", paper::slam_csv(results));
    core::write_file(folder_ / "results.json", paper::results_json(results).dump(1) + "\n");
    core::write_file(folder_ / "paper.html",
                     paper::page_html(results, tables, figures(), command_));
  }

  // By the Python package, if there is one.
  void draw() const {
    if (const auto why = run_python("samewhere.paper", {folder_.string()}))
      spdlog::warn("the figures are not drawn: {}; they need python3-matplotlib (Debian)", *why);
  }

  std::filesystem::path page() const { return folder_ / "paper.html"; }

 private:
  std::vector<paper::PageFigure> figures() const {
    const std::filesystem::path list = folder_ / "figures" / "figures.json";
    if (!core::is_there(list)) return {};
    std::vector<paper::PageFigure> figures;
    for (const auto& figure : nlohmann::json::parse(core::read_file(list))) {
      const auto file = folder_ / "figures" / figure.at("file").get<std::string>();
      figures.push_back({figure.at("title"), core::read_file(file)});
    }
    return figures;
  }

  std::filesystem::path folder_;
  paper::PaperTableNumbers numbers_;
  std::string command_;
};

// The pool for stores of up to this many views.
std::optional<paper::ViewPool> blind_spot_pool(const PaperCommand& command,
                                               const paper::BenchmarkPlan& plan) {
  constexpr int kNumQueries = 200;
  std::vector<pipeline::Config> configs;
  for (const std::string& source : plan.sources)
    configs.push_back(paper::with_source(plan.config, source));
  const auto by = paper::make_named_describer(paper::kPaperMethod, plan.config);
  return paper::make_view_pool(
      configs, *by.describer, {.num_stored = command.blind_spot_views, .num_queries = kNumQueries});
}

// False: interrupted.
bool measure_blind_spot(const PaperCommand& command, const paper::BenchmarkPlan& plan) {
  const auto pool = blind_spot_pool(command, plan);
  if (!pool) return false;
  const retrieve::Config& search = plan.config.retrieve;
  std::vector<int> num_draws{10, search.num_draws, 70};
  std::sort(num_draws.begin(), num_draws.end());
  num_draws.erase(std::unique(num_draws.begin(), num_draws.end()), num_draws.end());
  const auto points = paper::measure_blind_spot(*pool, search, num_draws);
  if (!points) return false;
  const std::filesystem::path folder = command.out;
  core::print("{}\n", paper::blind_spot_sentence(*points, search.num_draws));
  core::write_file(folder / "blind-spot.csv", paper::blind_spot_csv(*points));
  core::write_file(folder / "blind-spot.svg", paper::blind_spot_svg(*points, search));
  return true;
}

int execute(const PaperCommand& command) {
  core::catch_interrupts();
  const paper::BenchmarkPlan plan = plan_of(command);
  paper::check_plan(plan);
  const paper::RowStore store(std::filesystem::path(command.out) / "rows", command.is_fresh);
  const PaperFolder folder(command, plan.tables);
  const RenderedImages images(command.out);
  paper::Results results;
  const bool is_done = paper::run_benchmark(
      plan, store, results, [&](const paper::Results& so_far) { folder.write(so_far); });
  folder.write(results);
  if (!is_done) return core::kInterruptedExit;
  folder.draw();
  folder.write(results);  // with the figures
  for (const paper::PaperTable& table : paper::make_tables(results, plan.tables))
    core::print("{}\n", paper::as_text(table));
  if (command.blind_spot_views > 0 && !measure_blind_spot(command, plan))
    return core::kInterruptedExit;
  core::print("{}\n", folder.page().string());
  return core::kDone;
}

void add_options(CLI::App& sub, PaperCommand& command) {
  sub.add_option(
      "SOURCE", command.sources,
      "recordings and twin: buildings, each with the window of its protocol in frames or "
      "seconds: kitchen@149, twin:hotel@10s; without any, the data sets found below "
      "SAMEWHERE_DATA and four rendered sequences");
  sub.add_option(
         "--tables", command.tables,
         "2: AUC by number of draws, 3: milliseconds, 4 and 5: the same by method, 6: loops "
         "right and wrong, 7: trajectory error, 8: frames per second")
      ->capture_default_str();
  sub.add_option("--methods", command.methods,
                 fmt::format("{}, or ONNX files; without it all of them",
                             fmt::join(paper::all_methods(), ", ")))
      ->delimiter(',');
  sub.add_option("--seeds", command.num_seeds, "repetitions of the sampled search")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  sub.add_option("--runs", command.num_slam_runs, "repetitions of SLAM, which differ by seed")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  sub.add_flag("--quick", command.is_quick,
               "one rendered sequence unless some are named, two seeds, one run of SLAM");
  sub.add_flag("--fresh", command.is_fresh,
               "measure anew what an earlier run left in the folder's rows");
  sub.add_option("--blind-spot", command.blind_spot_views,
                 "also the probability that the search misses the true queue, in stores of up to "
                 "this many views (all sources and crops of them), e.g. 10000")
      ->check(CLI::Range(100, 1'000'000));
  sub.add_option(
         "--out", command.out,
         "folder for the results: paper.html, tables.txt, CSV, results.json, figures as SVG "
         "and PDF; a later run goes on with what is missing. Rendered images are kept in it until "
         "the end (2 GB), or where SAMEWHERE_CACHE says")
      ->capture_default_str();
  add_config_options(sub, command.config);
}

void add_paper_command(CLI::App& bench, int& exit_code) {
  auto command = std::make_shared<PaperCommand>();
  CLI::App* sub = bench.add_subcommand(
      "paper", "The tables and figures of the published method, beside other methods");
  add_options(*sub, *command);
  sub->footer(
      "Examples:\n"
      "  samewhere bench paper --quick\n"
      "  SAMEWHERE_DATA=~/data samewhere bench paper\n"
      "  samewhere bench paper kitchen@149 office@60 --tables 2-5 --methods paper,hog,ours");
  sub->callback([command, &exit_code] { exit_code = execute(*command); });
}

}  // namespace

void add_bench_command(CLI::App& app, int& exit_code) {
  CLI::App* sub = app.add_subcommand("bench", "Benchmark a method on several recordings");
  sub->require_subcommand(1);
  sub->footer("Example: samewhere bench paper --quick (see samewhere bench paper --help)");
  add_paper_command(*sub, exit_code);
}

}  // namespace samewhere::app
