#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/progress.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/core/similarity.hpp>
#include <samewhere/evaluate/statistics.hpp>
#include <samewhere/paper/blind_spot.hpp>
#include <samewhere/report/plot.hpp>
#include <samewhere/report/table.hpp>
#include <samewhere/retrieve/search.hpp>

namespace samewhere::paper {
namespace {

constexpr int kNumSeeds = 5;
constexpr int kSmallestStore = 100;
constexpr double kLargestDrawn = 100'000.0;

// 100, 200, 500, 1000, 2000 ... up to the largest.
std::vector<int> sizes_up_to(std::size_t largest) {
  std::vector<int> sizes;
  for (int decade = kSmallestStore; static_cast<std::size_t>(decade) <= largest; decade *= 10) {
    for (const int digit : {1, 2, 5}) {
      if (static_cast<std::size_t>(digit * decade) <= largest) sizes.push_back(digit * decade);
    }
  }
  return sizes;
}

// A store has whole groups to draw from, full or not: Table 1 of the published method.
int num_queues(int num_stored, const retrieve::Config& config) {
  const int num_groups = (num_stored + config.group_size - 1) / config.group_size;
  return num_groups * (config.group_size / config.queue_size);
}

// A store, and for each query the queue that a search should find.
class BlindSpotMeter {
 public:
  BlindSpotMeter(const ViewPool& pool, const retrieve::Config& config)
      : pool_(pool), config_(config), store_(config.group_size, config.queue_size) {}

  void grow_to(int num_stored) {
    while (store_.num_vectors() < num_stored) {
      const auto& view = pool_.stored[static_cast<std::size_t>(store_.num_vectors())];
      store_.append(view.frame, view.unit);
    }
    right_queues_.clear();
    for (const auto& query : pool_.queries) right_queues_.push_back(right_queue(query));
  }

  double share_missed(int num_draws) const {
    retrieve::Config config = config_;
    config.num_draws = num_draws;
    int num_missed = 0;
    for (std::size_t i = 0; i < right_queues_.size(); ++i) {
      for (std::uint64_t seed = 0; seed < kNumSeeds; ++seed) {
        core::Random random(core::seed_of(seed, "blind spot", i));
        const auto found = handed_on(pool_.queries[i], config, random);
        const bool is_found = std::any_of(found.begin(), found.end(), [&](const auto& view) {
          return view.position / config.queue_size == right_queues_[i];
        });
        num_missed += is_found ? 0 : 1;
      }
    }
    return num_missed / static_cast<double>(kNumSeeds * right_queues_.size());
  }

 private:
  int right_queue(const core::Descriptor& query) const {
    const auto scored =
        retrieve::exact_search(store_, {core::centred_unit(query.unit), store_.num_vectors()});
    return std::min_element(scored.begin(), scored.end(), retrieve::is_better)->position /
           config_.queue_size;
  }

  // What retrieve::Retriever gives.
  std::vector<retrieve::ScoredPosition> handed_on(const core::Descriptor& query,
                                                  const retrieve::Config& config,
                                                  core::Random& random) const {
    auto scored =
        retrieve::sampled_search(store_, {query.unit, store_.num_vectors()}, config, random);
    return retrieve::best_places(store_, std::move(scored), config);
  }

  const ViewPool& pool_;
  retrieve::Config config_;
  retrieve::SegmentedStore store_;
  std::vector<int> right_queues_;  // one a query
};

std::vector<report::PlotPoint> formula_curve(int num_draws, const retrieve::Config& config) {
  constexpr int kNumSteps = 200;
  std::vector<report::PlotPoint> points;
  for (int i = 0; i <= kNumSteps; ++i) {
    const double size = kSmallestStore * std::pow(kLargestDrawn / kSmallestStore,
                                                  static_cast<double>(i) / kNumSteps);
    const int num_stored = static_cast<int>(std::lround(size));
    points.push_back({static_cast<double>(num_stored),
                      evaluate::chance_of_missing(num_queues(num_stored, config), num_draws)});
  }
  return points;
}

}  // namespace

std::optional<std::vector<BlindSpotPoint>> measure_blind_spot(const ViewPool& pool,
                                                              const retrieve::Config& config,
                                                              const std::vector<int>& num_draws) {
  core::require(!pool.queries.empty(), "a pool has queries");
  BlindSpotMeter meter(pool, config);
  const std::vector<int> sizes = sizes_up_to(pool.stored.size());
  core::Progress progress("store sizes measured", static_cast<int>(sizes.size()));
  std::vector<BlindSpotPoint> points;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (core::is_interrupted()) return std::nullopt;
    meter.grow_to(sizes[i]);
    for (const int draws : num_draws) {
      points.push_back({sizes[i], draws,
                        evaluate::chance_of_missing(num_queues(sizes[i], config), draws),
                        static_cast<int>(pool.queries.size()), meter.share_missed(draws)});
    }
    progress.update(static_cast<int>(i) + 1);
  }
  return points;
}

std::string blind_spot_sentence(const std::vector<BlindSpotPoint>& points, int num_draws) {
  const auto last = std::find_if(points.rbegin(), points.rend(), [&](const BlindSpotPoint& point) {
    return point.num_draws == num_draws;
  });
  core::require(last != points.rend(), "the number of draws was measured");
  return fmt::format(
      "Among {} views, L = {} misses the right queue in {:.1f} % of the searches; {:.1f} % by the "
      "draws alone.",
      last->num_stored, num_draws, 100.0 * last->measured, 100.0 * last->expected);
}

std::string blind_spot_svg(const std::vector<BlindSpotPoint>& points,
                           const retrieve::Config& config) {
  report::Plot plot{.title = "The blind spot of the published search",
                    .note = blind_spot_sentence(points, config.num_draws),
                    .x = {"views in the store", kSmallestStore, kLargestDrawn, true},
                    .y = {"chance that the right queue is not found", 0.0, 1.0, false},
                    .curves = {}};
  std::set<int> all_draws;
  for (const BlindSpotPoint& point : points) all_draws.insert(point.num_draws);
  const std::vector<std::string> colours =
      report::colours_in_order(static_cast<int>(all_draws.size()));
  auto colour = colours.begin();
  for (const int draws : all_draws) {
    plot.curves.push_back({fmt::format("L = {}, formula", draws), formula_curve(draws, config),
                           *colour, report::PlotStyle::kLine});
    report::PlotCurve measured{
        fmt::format("L = {}, measured", draws), {}, *colour, report::PlotStyle::kMarks};
    for (const BlindSpotPoint& point : points) {
      if (point.num_draws == draws)
        measured.points.push_back({static_cast<double>(point.num_stored), point.measured});
    }
    plot.curves.push_back(measured);
    ++colour;
  }
  return report::plot_svg(plot);
}

std::string blind_spot_csv(const std::vector<BlindSpotPoint>& points) {
  report::Table table{{"views", "draws", "chance_of_missing", "queries", "measured"}, {}};
  for (const BlindSpotPoint& point : points) {
    table.rows.push_back({std::to_string(point.num_stored), std::to_string(point.num_draws),
                          fmt::format("{:.4f}", point.expected), std::to_string(point.num_queries),
                          fmt::format("{:.4f}", point.measured)});
  }
  return report::as_csv(table);
}

}  // namespace samewhere::paper
