// search SOURCE...: what does finding a view among many stored ones cost, step by step?
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "program.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/core/similarity.hpp>
#include <samewhere/core/timing.hpp>
#include <samewhere/describe/describer.hpp>
#include <samewhere/pipeline/open_source.hpp>
#include <samewhere/retrieve/retriever.hpp>
#include <samewhere/retrieve/search.hpp>

namespace samewhere::bench {
namespace {

constexpr std::uint64_t kQuerySeed = 1'000'000'000;  // no view that is stored has it

struct Options {
  std::vector<std::string> sources;
  std::vector<int> sizes{1000, 100'000};
  int num_queries = 200;
  pipeline::Config config = pipeline::profile("default");
  std::vector<std::string> assignments;
  std::string csv_file;
};

std::vector<cv::Mat> images_of(const Options& options) {
  std::vector<cv::Mat> images;
  for (const std::string& name : options.sources) {
    pipeline::Config config = options.config;
    config.source = pipeline::absolute_source(name);
    const auto source = pipeline::open_source(config);
    while (const auto frame = source->next()) images.push_back(frame->images.front().clone());
  }
  return images;
}

// View `number` of as many as are wanted: first the images as they are, then crops of them at
// random, half the side to all but a tenth of it.
cv::Mat view_of(const std::vector<cv::Mat>& images, std::uint64_t number) {
  const cv::Mat& image = images[number % images.size()];
  if (number < images.size()) return image;
  core::Random random(core::seed_of(1, "crop", number));
  const double scale = random.uniform(0.5, 0.9);
  const cv::Size size(static_cast<int>(scale * image.cols), static_cast<int>(scale * image.rows));
  const auto drawn = [&random](int bound) {
    return static_cast<int>(random.index(static_cast<std::uint64_t>(bound) + 1));
  };
  const int left = drawn(image.cols - size.width);
  const int top = drawn(image.rows - size.height);
  return image(cv::Rect(cv::Point(left, top), size));
}

// The time of one reading of what exact search reads: no search can be faster.
float sum_of_all(const retrieve::SegmentedStore& store) {
  constexpr std::size_t kNumLanes = 32;
  std::vector<float> sums(kNumLanes);
  for (int i = 0; i < store.num_vectors(); ++i) {
    const std::span<const float> vector = store.vector(i);
    for (std::size_t k = 0; k + kNumLanes <= vector.size(); k += kNumLanes) {
      for (std::size_t lane = 0; lane < kNumLanes; ++lane) sums[lane] += vector[k + lane];
    }
  }
  return *std::max_element(sums.begin(), sums.end());
}

// A store of real views that grows from size to size, and what each step of a query costs in it.
class SearchBench {
 public:
  explicit SearchBench(const Options& options)
      : options_(options),
        images_(images_of(options)),
        describer_(describe::make_describer(options.config.describe)),
        store_(options.config.retrieve.group_size, options.config.retrieve.queue_size) {
    core::require(!images_.empty(), "a source has frames");
  }

  void measure(int num_views, Table& table) {
    core::Timings timings;
    while (store_.num_vectors() < num_views) add_next(timings);
    for (int i = 0; i < options_.num_queries; ++i) query(static_cast<std::uint64_t>(i), timings);
    const double found = static_cast<double>(num_found_) / options_.num_queries;
    num_found_ = 0;
    for (const auto& [step, durations_ms] : timings.durations_ms()) {
      const core::TimingSummary summary = core::summarize(durations_ms);
      table.rows.push_back(
          {fmt::format("{} of {}", step, num_views), fmt::format("{:.4f}", summary.median_ms),
           fmt::format("{:.4f}", summary.p95_ms), fmt::format("{:.4f}", summary.p99_ms),
           step == "search, sampled" ? fmt::format("{:.2f}", found) : "",
           fmt::format("{:.0f}", core::peak_memory_mib())});
    }
  }

 private:
  core::Descriptor described(std::uint64_t number, std::uint64_t frame) {
    return describer_->describe(core::FrameId(frame), view_of(images_, number));
  }

  void add_next(core::Timings& timings) {
    const auto number = static_cast<std::uint64_t>(store_.num_vectors());
    core::Descriptor descriptor;
    {
      const core::ScopedTimer timer(timings, "describe");
      descriptor = described(number, number);
    }
    const core::ScopedTimer timer(timings, "store");
    store_.append(descriptor.frame, descriptor.unit);
  }

  void query(std::uint64_t number, core::Timings& timings) {
    const auto num_views = static_cast<std::uint64_t>(store_.num_vectors());
    const core::Descriptor query = described(kQuerySeed + number, num_views + number);
    const auto exact = best(exact_search(query, timings));
    const auto sampled = best(sampled_search(query, timings));
    if (!sampled.empty() && sampled.front().position == exact.front().position) ++num_found_;
    compare(query, exact, timings);
    const core::ScopedTimer timer(timings, "reading once");
    core::require(std::isfinite(sum_of_all(store_)), "descriptors are numbers");
  }

  std::vector<retrieve::ScoredPosition> exact_search(const core::Descriptor& query,
                                                     core::Timings& timings) const {
    const core::ScopedTimer timer(timings, "search, exact");
    return retrieve::exact_search(store_, {core::centred_unit(query.unit), store_.num_vectors()});
  }

  std::vector<retrieve::ScoredPosition> sampled_search(const core::Descriptor& query,
                                                       core::Timings& timings) const {
    const core::ScopedTimer timer(timings, "search, sampled");
    core::Random random(query.frame.value());
    return retrieve::sampled_search(store_, {query.unit, store_.num_vectors()},
                                    options_.config.retrieve, random);
  }

  std::vector<retrieve::ScoredPosition> best(std::vector<retrieve::ScoredPosition> scored) const {
    return retrieve::best_places(store_, std::move(scored), options_.config.retrieve);
  }

  void compare(const core::Descriptor& query, const std::vector<retrieve::ScoredPosition>& found,
               core::Timings& timings) const {
    const core::ScopedTimer timer(timings, "exact similarity");
    std::vector<retrieve::FoundView> views;
    for (const auto& scored : found) {
      const std::span<const float> vector = store_.vector(scored.position);
      views.push_back({store_.frame(scored.position), {vector.begin(), vector.end()}});
    }
    core::require(retrieve::compare(query, views).size() == found.size(), "each has a similarity");
  }

  const Options& options_;
  std::vector<cv::Mat> images_;
  std::unique_ptr<describe::Describer> describer_;
  retrieve::SegmentedStore store_;
  int num_found_ = 0;  // queries whose most similar view the sampled search has found
};

void measure(Options& options) {
  for (const auto& assignment : options.assignments) core::set_config(options.config, assignment);
  std::sort(options.sizes.begin(), options.sizes.end());
  Table table{{"step", "median ms", "p95", "p99", "best one found", "peak MiB so far"}, {}};
  SearchBench bench(options);
  for (const int size : options.sizes) bench.measure(size, table);
  publish(table, options.csv_file);
}

std::function<void()> set_up(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  app.name("search");
  app.description(
      "What finding a view among many costs, by step, on one core. The stored views are the "
      "sources'\n"
      "images and, when these are used up, random crops of them; the queries are other crops.");
  app.add_option("SOURCE", options->sources, "recordings and twin: buildings")->required();
  app.add_option("--sizes", options->sizes, "of the store, views")
      ->check(CLI::Range(1, 10'000'000))
      ->capture_default_str();
  app.add_option("--queries", options->num_queries, "in a store of each size")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  app.add_option("--set", options->assignments, "one setting, e.g. retrieve.num_draws=70")
      ->allow_extra_args(false);
  app.add_option("--csv", options->csv_file, "write the table to this file, too");
  return [options] { measure(*options); };
}

}  // namespace
}  // namespace samewhere::bench

int main(int argc, char** argv) {
  return samewhere::bench::run_program(argc, argv, samewhere::bench::set_up);
}
