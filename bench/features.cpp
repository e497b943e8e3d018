// features SOURCE...: time and repeatability of feature detection under known warps
#include <algorithm>
#include <array>
#include <ctime>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "known_warps.hpp"
#include "program.hpp"
#include <samewhere/core/grey.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/median.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/features/orb.hpp>
#include <samewhere/run/open_source.hpp>

namespace samewhere::bench {
namespace {

const cv::Size kPicture_px{640, 480};
constexpr int kNumRepeats = 5;  // of each timing

struct Options {
  std::vector<std::string> sources;
  int num_frames = 8;
  features::Config config;
  std::vector<std::string> assignments;
  bool by_change = false;
  std::string csv_file;
};

// Grey pictures from all parts of the source, brought to one size.
std::vector<cv::Mat> pictures_of(const std::string& name, int num_frames) {
  pipeline::Config config = pipeline::profile("default");
  config.source = run::absolute_source(name);
  const auto source = run::open_source(config);
  const int step = std::max(1, source->info().num_frames / num_frames);
  std::vector<cv::Mat> pictures;
  for (int i = 0; const auto frame = source->next(); ++i) {
    core::stop_if_interrupted();
    if (i % step != step / 2) continue;
    cv::Mat picture;
    cv::resize(core::as_grey(frame->images.front()), picture, kPicture_px, 0, 0, cv::INTER_AREA);
    pictures.push_back(picture);
  }
  return pictures;
}

using Extract = std::function<PointTable(const cv::Mat& grey)>;

struct Extractor {
  std::string name;
  Extract extract;
};

PointTable extract_plain(const cv::Mat& grey, int num_features) {
  const auto orb = cv::ORB::create(num_features);
  PointTable table;
  std::vector<cv::KeyPoint> keypoints;
  orb->detectAndCompute(grey, cv::noArray(), keypoints, table.descriptors);
  cv::KeyPoint::convert(keypoints, table.points_px);
  return table;
}

PointTable extract_ours(const cv::Mat& grey, const features::Config& config) {
  core::Frame frame;
  frame.rig = std::make_shared<const core::Rig>();
  frame.images = {grey};
  const features::View view = features::extract(frame, config);
  PointTable table{{}, view.features->descriptors};
  for (const auto& pixel : view.features->raw_px)
    table.points_px.emplace_back(pixel.x(), pixel.y());
  return table;
}

// Time of this program on a core, which neighbours on the machine disturb less than a clock on the
// wall.
double cpu_ms(const Extract& extract, const cv::Mat& grey) {
  const std::clock_t start = std::clock();
  extract(grey);
  return 1000.0 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

// Share of the 8 x 6 parts of a picture that hold a feature.
double evenness(const PointTable& table) {
  constexpr int kColumns = 8;
  constexpr int kRows = 6;
  std::set<std::pair<int, int>> parts;
  for (const auto& point : table.points_px) {
    parts.emplace(static_cast<int>(point.x * kColumns / kPicture_px.width),
                  static_cast<int>(point.y * kRows / kPicture_px.height));
  }
  return static_cast<double>(parts.size()) / (kColumns * kRows);
}

void add(Repeat& sum, const Repeat& repeat) {
  sum.num_visible += repeat.num_visible;
  sum.num_again += repeat.num_again;
  sum.num_matches += repeat.num_matches;
  sum.num_right += repeat.num_right;
  sum.errors_px.insert(sum.errors_px.end(), repeat.errors_px.begin(), repeat.errors_px.end());
}

std::string share(double part, double whole) {
  return whole > 0.0 ? fmt::format("{:.3f}", part / whole) : "-";
}

// What one extractor does with all pictures of a source, and with one change of them.
class Measurement {
 public:
  Measurement(const Extractor& extractor, const std::vector<cv::Mat>& pictures)
      : extractor_(extractor), pictures_(pictures) {
    for (const auto& picture : pictures) {
      firsts_.push_back(extractor.extract(picture));
      evenness_ += evenness(firsts_.back()) / static_cast<double>(pictures.size());
      num_features_ += static_cast<double>(firsts_.back().points_px.size()) /
                       static_cast<double>(pictures.size());
      for (int i = 0; i < kNumRepeats; ++i) times_ms_.push_back(cpu_ms(extractor.extract, picture));
    }
  }

  Repeat repeat(const Warp& warp) const {
    Repeat sum;
    for (std::size_t i = 0; i < pictures_.size(); ++i) {
      const cv::Mat second = warped(pictures_[i], warp, core::seed_of(1, warp.name, i));
      add(sum, find_again(firsts_[i], extractor_.extract(second), warp, kPicture_px));
    }
    return sum;
  }

  std::vector<std::string> row(const std::string& source, const std::string& change,
                               const Repeat& sum) const {
    return {source,
            extractor_.name,
            change,
            fmt::format("{:.2f}", core::median(times_ms_).value_or(0.0)),
            fmt::format("{:.0f}", num_features_),
            fmt::format("{:.2f}", evenness_),
            share(sum.num_again, sum.num_visible),
            share(sum.num_right, sum.num_visible),
            share(sum.num_right, sum.num_matches),
            fmt::format("{:.2f}", core::median(sum.errors_px).value_or(0.0))};
  }

 private:
  const Extractor& extractor_;
  const std::vector<cv::Mat>& pictures_;
  std::vector<PointTable> firsts_;
  std::vector<double> times_ms_;
  double evenness_ = 0.0;
  double num_features_ = 0.0;
};

void add_rows(const std::string& source, const std::vector<Extractor>& extractors,
              const Options& options, Table& table) {
  const std::vector<cv::Mat> pictures = pictures_of(source, options.num_frames);
  for (const auto& extractor : extractors) {
    const Measurement measurement(extractor, pictures);
    Repeat all;
    std::vector<std::vector<std::string>> rows;
    for (const auto& warp : known_warps(kPicture_px)) {
      const Repeat repeat = measurement.repeat(warp);
      rows.push_back(measurement.row(source, warp.name, repeat));
      add(all, repeat);
    }
    table.rows.push_back(measurement.row(source, "all", all));
    if (options.by_change) table.rows.insert(table.rows.end(), rows.begin(), rows.end());
  }
}

void measure(Options& options) {
  for (const auto& assignment : options.assignments) core::set_config(options.config, assignment);
  const features::Config& config = options.config;
  const std::vector<Extractor> extractors = {
      {"cv::ORB", [&](const cv::Mat& grey) { return extract_plain(grey, config.num_features); }},
      {"ours", [&](const cv::Mat& grey) { return extract_ours(grey, config); }}};
  Table table{{"source", "extractor", "change", "CPU ms", "features", "evenness", "repeated",
               "matched correctly", "correct of matches", "error px"},
              {}};
  for (const auto& source : options.sources) add_rows(source, extractors, options, table);
  publish(table, options.csv_file);
}

std::function<void()> set_up(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  app.name("features");
  app.description(
      "How fast features of a 640 x 480 picture are found, and how many of them are found and "
      "matched\n"
      "again (within 3 pixels) when the picture is turned, nearer, further, tilted, darker or "
      "brighter,\n"
      "beside the library's plain ORB. Shares are of the features that the changed picture shows.");
  app.add_option("SOURCE", options->sources, "recordings and twin: buildings")->required();
  app.add_option("--frames", options->num_frames, "so many of each source, evenly spaced")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_flag("--by-change", options->by_change, "a row for each change, too");
  app.add_option("--set", options->assignments, "one setting, e.g. cell_px=60")
      ->allow_extra_args(false);
  app.add_option("--csv", options->csv_file, "write the table to this file, too");
  return [options] { measure(*options); };
}

}  // namespace
}  // namespace samewhere::bench

int main(int argc, char** argv) {
  return samewhere::bench::run_program(argc, argv, samewhere::bench::set_up);
}
