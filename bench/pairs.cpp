// What tells two views of one place from two places that only look alike, once geometry takes both
// for one? For each source and each score of a pair: area under the ROC curve, and the share of
// true pairs kept when 1 % and 0.1 % of the wrong ones pass.

#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "program.hpp"
#include <samewhere/core/file.hpp>
#include <samewhere/core/median.hpp>
#include <samewhere/core/timing.hpp>
#include <samewhere/evaluate/separation.hpp>
#include <samewhere/pairs/labelled_pairs.hpp>
#include <samewhere/verify/pair_network.hpp>

namespace samewhere::bench {
namespace {

using pairs::LabelledPair;
using pairs::LabelledPairs;
using pairs::PairRule;
using verify::PairPlane;
using verify::PairView;

struct Options {
  std::vector<std::string> sources;
  PairRule rule;
  std::vector<std::string> networks = {"pairs.onnx"};
  std::string csv_file;
  std::string each_file;
};

// Of the two pictures, laid onto each other without their light, where both see; 0 if either shows
// nothing.
double correlation(const PairView& pair) {
  const cv::Mat query = pair.plane(PairPlane::kQuery);
  const cv::Mat match = pair.plane(PairPlane::kMatch);
  const double norms = std::sqrt(query.dot(query) * match.dot(match));
  return norms > 0.0 ? query.dot(match) / norms : 0.0;
}

// Of all that should be seen again in either view, how much is.
double share_seen_again(const PairView& pair) {
  const double seen = cv::sum(pair.plane(PairPlane::kAgree))[0];
  const double missed = cv::sum(pair.plane(PairPlane::kOnlyQueryShows))[0] +
                        cv::sum(pair.plane(PairPlane::kOnlyMatchShows))[0];
  return seen + missed > 0.0 ? seen / (seen + missed) : 0.0;
}

// Of a pair: first these, then what each network makes of it.
constexpr std::array<const char*, 3> kScores = {"inliers", "correlation", "seen again"};
using Scores = std::vector<double>;

struct Judge {
  std::string name;
  verify::PairNetwork network;
};

// Processor time of each pair, ms: other programs are not counted.
struct Times {
  std::vector<double> registering_ms;
  std::vector<double> judging_ms;
};

template <class Work>
auto timed(std::vector<double>& times_ms, const Work& work) {
  const double start_ms = core::thread_processor_ms();
  auto result = work();
  times_ms.push_back(core::thread_processor_ms() - start_ms);
  return result;
}

// A pair that cannot be registered scores below all others.
Scores scores_of(const LabelledPair& pair, const LabelledPairs& labelled,
                 std::vector<Judge>& judges, Times& times) {
  const auto num_inliers = static_cast<double>(pair.matches.size());
  const auto view = timed(times.registering_ms, [&] {
    return verify::register_pair(labelled.views[static_cast<std::size_t>(pair.query)],
                                 labelled.views[static_cast<std::size_t>(pair.match)], pair.matches,
                                 {});
  });
  Scores scores = {num_inliers, view ? correlation(*view) : -1.0,
                   view ? share_seen_again(*view) : -1.0};
  for (Judge& judge : judges) {
    scores.push_back(
        view ? timed(times.judging_ms, [&] { return judge.network.probability_of_same(*view); })
             : -1.0);
  }
  return scores;
}

std::vector<std::string> row_of(const std::string& source, const std::string& score,
                                const evaluate::Separation& found, const std::string& time) {
  const bool is_known = found.num_true > 0 && found.num_wrong > 0;
  const auto share = [is_known](double ratio) {
    return is_known ? fmt::format("{:.1f} %", 100.0 * ratio) : "-";
  };
  return {source,
          score,
          std::to_string(found.num_true),
          std::to_string(found.num_wrong),
          is_known ? fmt::format("{:.3f}", found.auc) : "-",
          share(found.kept_at_1_percent),
          share(found.kept_at_0_1_percent),
          time};
}

// Beside finding and matching features, which all scores need.
std::string time_of(std::size_t score, const Times& times) {
  if (score == 0) return "-";
  const double registering_ms = core::median(times.registering_ms).value_or(0.0);
  if (score < kScores.size()) return fmt::format("{:.1f}", registering_ms);
  return fmt::format("{:.1f} + {:.1f}", registering_ms,
                     core::median(times.judging_ms).value_or(0.0));
}

std::vector<std::string> names_of(const std::vector<Judge>& judges) {
  std::vector<std::string> names(kScores.begin(), kScores.end());
  for (const Judge& judge : judges) names.push_back(judge.name);
  return names;
}

std::vector<std::string> row_of(const std::string& source, const LabelledPair& pair,
                                const LabelledPairs& labelled, const Scores& scores) {
  const auto frame_of = [&](int view) {
    return fmt::format("{}", labelled.views[static_cast<std::size_t>(view)].view.frame.index());
  };
  std::vector<std::string> row = {source, frame_of(pair.query), frame_of(pair.match),
                                  pair.is_same ? "same" : "different"};
  for (const double score : scores) row.push_back(fmt::format("{:.6g}", score));
  return row;
}

struct Tables {
  Table separation;
  Table each;
};

void measure(const std::string& source, const Options& options, std::vector<Judge>& judges,
             Tables& tables) {
  const LabelledPairs labelled = pairs::labelled_pairs(source, options.rule);
  const std::vector<std::string> names = names_of(judges);
  std::vector<std::vector<double>> of_true(names.size());
  std::vector<std::vector<double>> of_wrong(names.size());
  Times times;
  for (const LabelledPair& pair : labelled.pairs) {
    const Scores scores = scores_of(pair, labelled, judges, times);
    tables.each.rows.push_back(row_of(source, pair, labelled, scores));
    for (std::size_t i = 0; i < scores.size(); ++i)
      (pair.is_same ? of_true : of_wrong)[i].push_back(scores[i]);
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    tables.separation.rows.push_back(row_of(
        source, names[i], evaluate::separation_of(of_true[i], of_wrong[i]), time_of(i, times)));
  }
}

void measure_all(const Options& options) {
  Tables tables{
      .separation = {.header = {"source", "score", "true", "wrong", "AUC", "kept at 1 % wrong",
                                "kept at 0.1 % wrong", "processor ms a pair, median"},
                     .rows = {}},
      .each = {.header = {"source", "query", "match", "truth"}, .rows = {}}};
  cv::setNumThreads(1);
  std::vector<Judge> judges;
  for (const std::string& file : options.networks) {
    const std::string name = std::filesystem::path(file).stem().string();
    judges.push_back({options.networks.size() == 1 ? "network" : "network " + name,
                      verify::PairNetwork("--network", file)});
  }
  for (const std::string& name : names_of(judges)) tables.each.header.push_back(name);
  for (const std::string& source : options.sources) measure(source, options, judges, tables);
  publish(tables.separation, options.csv_file);
  if (!options.each_file.empty()) core::write_file(options.each_file, as_csv(tables.each));
}

std::function<void()> set_up(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.name("pairs");
  app.description(
      "Pairs of views that one geometry explains: how well do scores tell one "
      "place\n"
      "from two that look alike?");
  app.add_option(
         "SOURCE", options->sources,
         "recordings with place truth, the folder of IE Tower (FOLDER?floors=floor3,floor5: some "
         "of its floors), or twin:PRESET?similarity=S")
      ->required();
  app.add_option("--step", options->rule.step,
                 "every so many frames is a view; of IE Tower each is")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--query-step", options->rule.query_step,
                 "of IE Tower: every so many views is asked")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--window", options->rule.window_frames,
                 "frames no further apart are no pair (evaluation.md, table of pr-v2)")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--min-matches", options->rule.min_matches,
                 "pairs of which fewer matches agree on one geometry are left out")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--network", options->networks, "ONNX files that judge a registered pair")
      ->capture_default_str();
  app.add_option("--csv", options->csv_file, "write the table to this file, too");
  app.add_option("--each", options->each_file,
                 "write each pair's frames and scores to this file (CSV): to look at the errors");
  return [options] { measure_all(*options); };
}

}  // namespace
}  // namespace samewhere::bench

int main(int argc, char** argv) {
  return samewhere::bench::run_program(argc, argv, samewhere::bench::set_up);
}
