// aliased_pairs SOURCE...: how similar are views of different places? For each query the most ORB
// inliers of one fundamental matrix, the usual check, among the most similar frames of other places
// (by MobileNetV2 and by HOG).

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "aliased_pair_rule.hpp"
#include "most_alike.hpp"
#include "orb_matches.hpp"
#include "program.hpp"
#include "tower.hpp"
#include "whole_view.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/grey.hpp>
#include <samewhere/core/median.hpp>
#include <samewhere/core/progress.hpp>
#include <samewhere/describe/describer.hpp>
#include <samewhere/run/open_source.hpp>

namespace samewhere::bench {
namespace {

constexpr int kShortlist = 50;
constexpr int kOrbFeatures = 1500;
constexpr std::array<int, 4> kGates = {12, 20, 30, 50};

struct Options {
  std::vector<std::string> sources;
  std::string network;
  int query_step = 5;
  int num_tower_queries = 150;
  std::string csv_file;
};

// Features and descriptors of all frames of a source; each frame is rendered or read once.
struct SourceViews {
  KnownFrames known;
  std::vector<OrbFeatures> orb;
  std::vector<std::vector<float>> mobilenet;
  std::vector<std::vector<float>> hog;
};

cv::Mat as_bgr(const cv::Mat& image) {
  if (image.channels() == 3) return image;
  cv::Mat bgr;
  cv::cvtColor(image, bgr, cv::COLOR_GRAY2BGR);
  return bgr;
}

SourceViews view(const std::string& name, MobileNet& mobilenet) {
  pipeline::Config config = pipeline::profile("default");
  config.source = is_tower(name) ? (std::filesystem::path(name) / "walk.txt").string() : name;
  const auto source = run::open_source(config);
  const auto describer = describe::make_describer(config.describe);
  core::Progress progress("describing " + name, source->info().num_frames);
  SourceViews views;
  while (const auto frame = source->next()) {
    const cv::Mat& image = frame->images.front();
    views.known.names.push_back(frame->name);
    views.known.stamps_s.push_back(frame->stamp_s);
    views.orb.push_back(extract_orb(core::as_grey(image), kOrbFeatures));
    views.mobilenet.push_back(mobilenet.describe(as_bgr(image)));
    views.hog.push_back(describer->describe(frame->id, image).unit);
    progress.update(static_cast<int>(views.orb.size()));
  }
  views.known.truth = source->truth();
  return views;
}

// Inliers of a pair, counted once even if it is on several shortlists.
class InlierCounts {
 public:
  explicit InlierCounts(const std::vector<OrbFeatures>& orb) : orb_(orb) {}

  int of(int query, int match) {
    const auto [entry, is_new] = counts_.try_emplace({query, match}, 0);
    if (is_new) {
      entry->second = count_inliers(orb_[static_cast<std::size_t>(query)],
                                    orb_[static_cast<std::size_t>(match)]);
    }
    return entry->second;
  }

 private:
  const std::vector<OrbFeatures>& orb_;
  std::map<std::pair<int, int>, int> counts_;
};

std::vector<int> offered_to(int query, const AliasedPairRule& rule, int num_frames) {
  std::vector<int> offered;
  for (int match = 0; match < num_frames; ++match) {
    if (match != query && rule.offer(query, match) != Offer::kTakenOut) offered.push_back(match);
  }
  return offered;
}

// Inliers of the frame on the shortlist with most inliers; 0 if it shows the same place.
int inliers_of_best(int query, const std::vector<int>& shortlist, const AliasedPairRule& rule,
                    InlierCounts& counts) {
  int most = 0;
  bool is_aliased = false;
  for (const int match : shortlist) {
    const int num_inliers = counts.of(query, match);
    if (num_inliers <= most) continue;
    most = num_inliers;
    is_aliased = rule.offer(query, match) == Offer::kAliased;
  }
  return is_aliased ? most : 0;
}

// For each query with a shortlist: most inliers of an aliased view.
std::vector<int> inliers_of_best_aliased(const std::vector<std::vector<float>>& vectors,
                                         const AliasedPairRule& rule, InlierCounts& counts) {
  core::Progress progress("matching " + rule.name, static_cast<int>(rule.queries.size()));
  std::vector<int> best;
  int num_done = 0;
  for (const int query : rule.queries) {
    const auto offered = offered_to(query, rule, static_cast<int>(vectors.size()));
    const auto shortlist = most_alike(vectors, query, offered, kShortlist);
    if (!shortlist.empty()) best.push_back(inliers_of_best(query, shortlist, rule, counts));
    progress.update(++num_done);
  }
  return best;
}

std::string share_at_least(int gate, const std::vector<int>& best) {
  if (best.empty()) return "-";
  const auto num = std::count_if(best.begin(), best.end(), [gate](int n) { return n >= gate; });
  return fmt::format("{:.1f} %",
                     100.0 * static_cast<double>(num) / static_cast<double>(best.size()));
}

std::string median_of(std::vector<int> best) {
  const auto median = core::median(std::move(best));
  return median ? std::to_string(*median) : "-";
}

void measure(const std::string& name, const Options& options, MobileNet& mobilenet, Table& table) {
  const SourceViews views = view(name, mobilenet);
  const std::vector<AliasedPairRule> rules =
      is_tower(name) ? std::vector{tower_rule(name, options.num_tower_queries)}
                     : rules_of_truth(views.known, options.query_step);
  InlierCounts counts(views.orb);
  for (const AliasedPairRule& rule : rules) {
    for (const auto& [method, vectors] :
         {std::pair("MobileNetV2", &views.mobilenet), std::pair("HOG", &views.hog)}) {
      const std::vector<int> best = inliers_of_best_aliased(*vectors, rule, counts);
      std::vector<std::string> row = {name, rule.name, method, std::to_string(best.size())};
      for (const int gate : kGates) row.push_back(share_at_least(gate, best));
      row.push_back(median_of(best));
      table.rows.push_back(row);
    }
  }
}

std::string default_network() {
  const char* const data = std::getenv("SAMEWHERE_DATA");
  return data == nullptr ? "" : std::string(data) + "/../models/mobilenet_v2.onnx";
}

void measure_all(const Options& options) {
  MobileNet mobilenet(options.network);
  Table table{.header = {"source", "offered", "shortlist by", "queries"}, .rows = {}};
  for (const int gate : kGates) table.header.push_back(fmt::format(">= {}", gate));
  table.header.emplace_back("median inliers");
  for (const std::string& name : options.sources) measure(name, options, mobilenet, table);
  publish(table, options.csv_file);
}

std::function<void()> set_up(CLI::App& app) {
  auto options = std::make_shared<Options>();
  options->network = default_network();
  app.name("aliased_pairs");
  app.description(
      "Share of queries with an aliased view of at least so many inliers: most ORB matches (1500\n"
      "features, ratio 0.8) under one fundamental matrix, among the 50 most similar frames "
      "without\n"
      "the place of the query.");
  app.add_option("SOURCE", options->sources,
                 "recordings with place truth, the folder of IE Tower, or twin:PRESET?similarity=S")
      ->required();
  app.add_option("--network", options->network, "MobileNetV2 as ONNX with an output `embedding`")
      ->capture_default_str();
  app.add_option("--step", options->query_step, "frames from one query to the next")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--tower-queries", options->num_tower_queries,
                 "number of queries on IE Tower, drawn by a fixed permutation")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--csv", options->csv_file, "write the table to this file, too");
  return [options] { measure_all(*options); };
}

}  // namespace
}  // namespace samewhere::bench

int main(int argc, char** argv) {
  return samewhere::bench::run_program(argc, argv, samewhere::bench::set_up);
}
