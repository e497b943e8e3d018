#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <opencv2/core/mat.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/progress.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/core/similarity.hpp>
#include <samewhere/evaluate/statistics.hpp>
#include <samewhere/input/prefetch.hpp>
#include <samewhere/pipeline/blind_spot.hpp>
#include <samewhere/pipeline/open_source.hpp>
#include <samewhere/report/plot.hpp>
#include <samewhere/report/table.hpp>
#include <samewhere/retrieve/search.hpp>

namespace samewhere::pipeline {
namespace {

constexpr int kNumQueries = 200;
constexpr int kNumSeeds = 5;
constexpr int kSmallestStore = 100;
constexpr double kLargestDrawn = 100'000.0;

// Number `number` of the random crops of a picture: half of its sides to all but a tenth.
cv::Mat crop(const cv::Mat& image, std::uint64_t frame, std::uint64_t number) {
  core::Random random(core::seed_of(frame, "crop", number));
  const double scale = random.uniform(0.5, 0.9);
  const cv::Size size(std::max(1, static_cast<int>(scale * image.cols)),
                      std::max(1, static_cast<int>(scale * image.rows)));
  const auto drawn = [&random](int bound) {
    return static_cast<int>(random.index(static_cast<std::uint64_t>(bound) + 1));
  };
  const int left = drawn(image.cols - size.width);
  const int top = drawn(image.rows - size.height);
  return image(cv::Rect(cv::Point(left, top), size));
}

// Fills the pool: round 0 of each frame is the frame itself, the others are crops of it.
class PoolMaker {
 public:
  PoolMaker(describe::Describer& describer, int num_frames, int num_stored)
      : describer_(describer),
        rounds_(static_cast<std::size_t>((num_stored + num_frames - 1) / num_frames)),
        query_step_(static_cast<std::uint64_t>(std::max(1, num_frames / kNumQueries))),
        num_stored_(static_cast<std::size_t>(num_stored)) {}

  void add(const cv::Mat& image) {
    for (std::size_t round = 0; round < rounds_.size(); ++round)
      rounds_[round].push_back(described(round == 0 ? image : crop(image, num_added_, round)));
    if (num_added_ % query_step_ == 0 && pool_.queries.size() < kNumQueries)
      pool_.queries.push_back(described(crop(image, num_added_, rounds_.size())));
    ++num_added_;
  }

  ViewPool pool() && {
    for (const auto& round : rounds_)
      pool_.stored.insert(pool_.stored.end(), round.begin(), round.end());
    pool_.stored.resize(std::min(pool_.stored.size(), num_stored_));
    for (std::size_t i = 0; i < pool_.stored.size(); ++i) pool_.stored[i].frame = core::FrameId(i);
    return std::move(pool_);
  }

 private:
  core::Descriptor described(const cv::Mat& image) {
    return describer_.describe(core::FrameId(num_added_), image);
  }

  describe::Describer& describer_;
  std::vector<std::vector<core::Descriptor>> rounds_;
  std::uint64_t query_step_;
  std::size_t num_stored_;
  std::uint64_t num_added_ = 0;
  ViewPool pool_;
};

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

// A store, the queries that it holds something like, and in which queue.
class BlindSpotMeter {
 public:
  BlindSpotMeter(const ViewPool& pool, const retrieve::Config& config)
      : pool_(pool), config_(config), store_(config.group_size, config.queue_size) {}

  void grow_to(int num_stored) {
    while (store_.num_vectors() < num_stored) {
      const auto& view = pool_.stored[static_cast<std::size_t>(store_.num_vectors())];
      store_.append(view.frame, view.unit);
    }
    asked_.clear();
    for (const auto& query : pool_.queries) {
      const int right = right_position(query);
      if (core::dot(query.unit, store_.vector(right)) > config_.min_similarity)
        asked_.push_back({&query, right / config_.queue_size});
    }
    if (!asked_.empty()) return;
    throw core::InputError(
        fmt::format("none of {} views resembles any of {} stored ones by more than "
                    "retrieve.min_similarity = {}",
                    pool_.queries.size(), num_stored, config_.min_similarity));
  }

  int num_queries() const { return static_cast<int>(asked_.size()); }

  double share_missed(int num_draws) const {
    retrieve::Config config = config_;
    config.num_draws = num_draws;
    int num_missed = 0;
    for (std::size_t i = 0; i < asked_.size(); ++i) {
      for (std::uint64_t seed = 0; seed < kNumSeeds; ++seed) {
        core::Random random(core::seed_of(seed, "blind spot", i));
        const auto found = retrieve::sampled_search(
            store_, {asked_[i].query->unit, store_.num_vectors()}, config, random);
        const bool is_found = std::any_of(found.begin(), found.end(), [&](const auto& view) {
          return view.position / config.queue_size == asked_[i].right_queue;
        });
        num_missed += is_found ? 0 : 1;
      }
    }
    return num_missed / static_cast<double>(kNumSeeds * asked_.size());
  }

 private:
  struct Asked {
    const core::Descriptor* query;
    int right_queue;
  };

  int right_position(const core::Descriptor& query) const {
    const auto scored =
        retrieve::exact_search(store_, {core::centred_unit(query.unit), store_.num_vectors()});
    return std::min_element(scored.begin(), scored.end(), retrieve::is_better)->position;
  }

  const ViewPool& pool_;
  retrieve::Config config_;
  retrieve::SegmentedStore store_;
  std::vector<Asked> asked_;
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

std::optional<ViewPool> make_view_pool(const std::vector<Config>& sources,
                                       describe::Describer& describer, int num_stored) {
  int num_frames = 0;
  for (const Config& config : sources) num_frames += open_source(config)->info().num_frames;
  core::require(num_stored > 0, "a pool has views");
  if (num_frames <= 0) throw core::InputError("the sources hold no frame; expected at least one");
  PoolMaker maker(describer, num_frames, num_stored);
  core::Progress progress("frames and crops described", num_frames);
  int num_done = 0;
  for (const Config& config : sources) {
    const auto source = input::prefetched(open_source(config));
    while (const std::optional<core::Frame> frame = source->next()) {
      if (core::is_interrupted()) return std::nullopt;
      maker.add(frame->images.front());
      progress.update(++num_done);
    }
  }
  return std::move(maker).pool();
}

std::optional<std::vector<BlindSpotPoint>> measure_blind_spot(const ViewPool& pool,
                                                              const retrieve::Config& config,
                                                              const std::vector<int>& num_draws) {
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
                        meter.num_queries(), meter.share_missed(draws)});
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
      "Among {} views, {} draws miss the queue of the most similar one with a chance of "
      "{:.1f} % (measured: {:.1f} %).",
      last->num_stored, num_draws, 100.0 * last->expected, 100.0 * last->measured);
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

}  // namespace samewhere::pipeline
