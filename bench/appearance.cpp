// Does a rendered building look like a photo to a feature matcher? For each source: corners, tones,
// noise and spectrum of its pictures, and how the ORB matches between two views fall off with
// baseline and angle; rendered sources beside the nearest recorded one.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "orb_matches.hpp"
#include "picture_statistics.hpp"
#include "program.hpp"
#include "view_pairs.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/grey.hpp>
#include <samewhere/core/progress.hpp>
#include <samewhere/evaluate/trajectory_error.hpp>
#include <samewhere/run/open_source.hpp>
#include <samewhere/twin/building/spec.hpp>

namespace samewhere::bench {
namespace {

constexpr int kOrbFeatures = 1000;
constexpr std::size_t kMinPairs = 10;  // fewer say nothing
constexpr double kMaxFactor = 2.0;

struct Options {
  std::vector<std::string> sources;
  int width_px = 0;
  int num_pictures = 100;
  int num_pairs = 60;
  std::string csv_file;
};

// A figure of one source; nothing where there is too little to say it.
struct Figure {
  std::string name;
  std::optional<double> value;
};

struct SourceFigures {
  std::string name;
  bool is_twin = false;
  std::vector<Figure> figures;  // the same names in the same order for every source
};

std::unique_ptr<core::Source> open(const std::string& name) {
  pipeline::Config config = pipeline::profile("default");
  config.source = name;
  config.twin.ideal_depth = true;  // the range of a sensor would shorten the median depth
  return run::open_source(config);
}

int smallest_width_px(const std::vector<std::string>& sources) {
  int width_px = std::numeric_limits<int>::max();
  for (const std::string& name : sources) {
    const auto first = open(name)->next();
    if (!first) throw core::InputError(name + ": holds no frame");
    width_px = std::min(width_px, first->images.front().cols);
  }
  return width_px;
}

cv::Mat at_width(const cv::Mat& image, int width_px) {
  if (image.cols == width_px) return image;
  const int height_px =
      static_cast<int>(std::lround(static_cast<double>(image.rows) * width_px / image.cols));
  cv::Mat resized;
  cv::resize(image, resized, cv::Size(width_px, height_px), 0.0, 0.0, cv::INTER_AREA);
  return resized;
}

// What is kept of a source after its frames went by.
struct Views {
  std::vector<PictureStatistics> pictures;
  std::vector<ViewGeometry> geometry;
  std::vector<OrbFeatures> orb;  // of the same frames as geometry
};

void add_view(const core::Frame& frame, const core::Trajectory& trajectory, const cv::Mat& picture,
              Views& views) {
  const auto world_from_camera = evaluate::truth_at(trajectory, frame.stamp_s);
  if (!world_from_camera || !frame.depth_m || !frame.rig || !frame.rig->is_calibrated()) return;
  views.geometry.push_back(view_geometry(frame, *world_from_camera));
  views.orb.push_back(extract_orb(core::as_grey(picture), kOrbFeatures));
}

Views look_at(const std::string& name, const Options& options) {
  const auto source = open(name);
  const core::Trajectory trajectory = source->truth().trajectory;
  const int num_frames = source->info().num_frames;
  const int picture_step = std::max(1, num_frames / options.num_pictures);
  core::Progress progress("looking at " + name, num_frames);
  Views views;
  int num_seen = 0;
  while (const auto frame = source->next()) {
    const cv::Mat picture = at_width(frame->images.front(), options.width_px);
    if (num_seen % picture_step == 0) views.pictures.push_back(picture_statistics(picture));
    add_view(*frame, trajectory, picture, views);
    progress.update(++num_seen);
  }
  return views;
}

std::optional<double> quantile(std::vector<double> values, double ratio) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(ratio * static_cast<double>(values.size() - 1))];
}

void add_picture_figures(const Views& views, std::vector<Figure>& figures) {
  for (const PictureFigure& figure : kPictureFigures) {
    std::vector<double> values;
    for (const PictureStatistics& picture : views.pictures) {
      values.push_back(picture.*figure.value);
    }
    figures.push_back({std::string(figure.name), quantile(values, 0.5)});
    if (figure.value != &PictureStatistics::num_fast_corners) continue;
    figures.push_back({"FAST corners, 10th percentile", quantile(values, 0.1)});
    figures.push_back({"FAST corners, 90th percentile", quantile(values, 0.9)});
  }
}

// Pairs of views that are counted together.
struct PairFigures {
  std::vector<double> inliers;
  std::vector<double> inlier_ratios;
  std::vector<double> overlaps;
};

void add_pair(const ViewPair& pair, int num_inliers, int num_features, PairFigures& figures) {
  figures.inliers.push_back(num_inliers);
  figures.inlier_ratios.push_back(static_cast<double>(num_inliers) / std::max(1, num_features));
  figures.overlaps.push_back(pair.overlap);
}

// By class for each way; all together by parallax.
struct MatchFigures {
  std::array<std::array<PairFigures, kNumClasses>, kWays.size()> by_class;
  std::array<PairFigures, kAngles_deg.size() - 1> by_parallax;
};

void add_by_parallax(const ViewPair& pair, int num_inliers, int num_features,
                     MatchFigures& figures) {
  const auto above =
      std::upper_bound(kAngles_deg.begin() + 1, kAngles_deg.end(), pair.parallax_deg);
  if (above == kAngles_deg.end()) return;
  const auto bin = static_cast<std::size_t>(above - kAngles_deg.begin()) - 1;
  add_pair(pair, num_inliers, num_features, figures.by_parallax[bin]);
}

void match_way(Way way, const Views& views, int num_pairs, MatchFigures& figures) {
  const auto drawn = draw_pairs(views.geometry, way, num_pairs);
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    for (const ViewPair& pair : drawn[i]) {
      const OrbFeatures& first = views.orb[static_cast<std::size_t>(pair.first)];
      const OrbFeatures& second = views.orb[static_cast<std::size_t>(pair.second)];
      const int num_inliers = count_inliers(first, second);
      add_pair(pair, num_inliers, first.size(), figures.by_class[static_cast<std::size_t>(way)][i]);
      if (way == Way::kAny) add_by_parallax(pair, num_inliers, first.size(), figures);
    }
  }
}

MatchFigures match(const std::string& name, const Views& views, int num_pairs) {
  core::Progress progress("matching pairs of " + name, static_cast<int>(kWays.size()));
  MatchFigures figures;
  int num_done = 0;
  for (const Way way : kWays) {
    match_way(way, views, num_pairs, figures);
    progress.update(++num_done);
  }
  return figures;
}

// What is told of a class of pairs.
struct PairFigure {
  const char* name;
  std::vector<double> PairFigures::*values;
};

constexpr std::array<PairFigure, 3> kPairFigures = {
    {{"inliers", &PairFigures::inliers},
     {"inliers / features", &PairFigures::inlier_ratios},
     {"overlap", &PairFigures::overlaps}}};

std::optional<double> median(const PairFigures& pairs, const PairFigure& figure) {
  const std::vector<double>& values = pairs.*figure.values;
  return values.size() >= kMinPairs ? quantile(values, 0.5) : std::nullopt;
}

void add_class_figures(const MatchFigures& matches, Way way, const PairFigure& figure,
                       std::vector<Figure>& figures) {
  constexpr std::array<const char*, kWays.size()> kNames = {"", "sideways ", "forward "};
  const auto& by_class = matches.by_class[static_cast<std::size_t>(way)];
  for (std::size_t i = 0; i < by_class.size(); ++i) {
    figures.push_back({fmt::format("{}, {}{}", figure.name, kNames[static_cast<std::size_t>(way)],
                                   class_name(static_cast<int>(i))),
                       median(by_class[i], figure)});
  }
}

void add_match_figures(const MatchFigures& matches, std::vector<Figure>& figures) {
  for (const PairFigure& figure : kPairFigures) {
    for (std::size_t i = 0; i < matches.by_parallax.size(); ++i) {
      figures.push_back(
          {fmt::format("{}, parallax {}-{} deg", figure.name, kAngles_deg[i], kAngles_deg[i + 1]),
           median(matches.by_parallax[i], figure)});
    }
    add_class_figures(matches, Way::kAny, figure, figures);
  }
  for (const Way way : {Way::kSideways, Way::kForward}) {
    add_class_figures(matches, way, kPairFigures.front(), figures);
  }
}

SourceFigures measure(const std::string& name, const Options& options) {
  const Views views = look_at(name, options);
  SourceFigures source{.name = name, .is_twin = twin::is_twin_spec(name), .figures = {}};
  add_picture_figures(views, source.figures);
  add_match_figures(match(name, views, options.num_pairs), source.figures);
  return source;
}

// The value over that of the recorded source nearest to it, 1 between two of them: a picture may
// well be like either. Nothing where there is none.
std::optional<double> ratio_to_nearest(double value, std::size_t row,
                                       const std::vector<SourceFigures>& sources) {
  const auto log_of = [](double x) { return std::log(std::max(x, 1e-9)); };
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (const SourceFigures& source : sources) {
    const std::optional<double>& real = source.figures[row].value;
    if (source.is_twin || !real) continue;
    lowest = std::min(lowest, *real);
    highest = std::max(highest, *real);
  }
  if (lowest > highest) return std::nullopt;
  return std::exp(log_of(value) - log_of(std::clamp(value, lowest, highest)));
}

std::string as_cell(const std::optional<double>& value) {
  if (!value) return "-";
  return std::abs(*value) >= 100.0 ? fmt::format("{:.0f}", *value) : fmt::format("{:.3g}", *value);
}

// "1.3", or "3.1 !" outside the factor.
std::string ratio_cell(const std::optional<double>& ratio) {
  if (!ratio) return "-";
  if (*ratio > 1000.0 || *ratio < 0.001) return *ratio > 1.0 ? "> 1000 !" : "< 0.001 !";
  const bool is_within = *ratio <= kMaxFactor && *ratio >= 1.0 / kMaxFactor;
  return fmt::format("{:.2f}{}", *ratio, is_within ? "" : " !");
}

Table comparison(const std::vector<SourceFigures>& sources) {
  Table table{.header = {"median of"}, .rows = {}};
  for (const SourceFigures& source : sources) {
    table.header.push_back(source.name);
    if (source.is_twin) table.header.emplace_back("to nearest real");
  }
  for (std::size_t row = 0; row < sources.front().figures.size(); ++row) {
    std::vector<std::string> cells = {sources.front().figures[row].name};
    for (const SourceFigures& source : sources) {
      const std::optional<double>& value = source.figures[row].value;
      cells.push_back(as_cell(value));
      if (!source.is_twin) continue;
      cells.push_back(ratio_cell(value ? ratio_to_nearest(*value, row, sources) : std::nullopt));
    }
    table.rows.push_back(cells);
  }
  return table;
}

void measure_all(Options options) {
  if (options.width_px == 0) options.width_px = smallest_width_px(options.sources);
  fmt::print("pictures {} px wide\n", options.width_px);
  std::vector<SourceFigures> sources;
  for (const std::string& name : options.sources) sources.push_back(measure(name, options));
  publish(comparison(sources), options.csv_file);
}

std::function<void()> set_up(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.name("appearance");
  app.description(
      "How the pictures of sources look to a feature matcher: corners, tones, noise, spectrum, "
      "and\n"
      "the inliers of 1000 ORB features (ratio 0.8) under one fundamental matrix, by baseline "
      "over\n"
      "median depth and by angle between the views; the same apart for baselines that run aside "
      "and forward. '!' marks what is further than a factor of two from every recorded source.");
  app.add_option("SOURCE", options->sources, "recordings with depth and poses, or twin:PRESET")
      ->required();
  app.add_option("--width", options->width_px,
                 "width in pixels that all pictures are brought to; 0: that of the smallest")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  app.add_option("--pictures", options->num_pictures, "so many frames for the statistics")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--pairs", options->num_pairs, "so many pairs of views of each class")
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
