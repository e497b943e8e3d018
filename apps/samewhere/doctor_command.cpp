#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <Eigen/Core>
#include <ceres/version.h>
#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "commands.hpp"
#include "options.hpp"
#include "print.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/stage_thread.hpp>
#include <samewhere/core/timing.hpp>
#include <samewhere/describe/describer.hpp>
#include <samewhere/describe/preprocess.hpp>
#include <samewhere/network/inference.hpp>
#include <samewhere/twin/render/picture_cache.hpp>
#include <samewhere/twin/render/ray_scene.hpp>

namespace samewhere::app {
namespace {

std::string picture_cache() {
  if (!twin::can_render()) return "none: built without (SAMEWHERE_TWIN=OFF)";
  const auto place = twin::cache_place_from_environment();
  if (!place) return "off (SAMEWHERE_CACHE is unset)";
  std::error_code ignored;  // what cannot be looked at is not there
  return fmt::format("{} ({}, {} MB at most)", place->root.string(),
                     std::filesystem::is_directory(place->root, ignored) ? "a folder" : "not there",
                     place->max_bytes / 1'000'000);
}

std::vector<report::Figure> system_figures() {
  return {
      {"samewhere", SAMEWHERE_VERSION},
      {"build", SAMEWHERE_BUILD_TYPE ", " SAMEWHERE_COMPILER},
      {"OpenCV", CV_VERSION},
      {"Eigen",
       fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
      {"Ceres", CERES_VERSION_STRING},
      {"threads", fmt::format("{} on this machine, {} in OpenCV", core::num_hardware_threads(),
                              cv::getNumThreads())},
      {"networks run by", network::inference_backend()},
      {"rendered pictures", picture_cache()},
  };
}

// Edges in every direction, 640x480 BGR; what it shows makes no difference to the time.
cv::Mat test_picture() {
  cv::Mat picture(480, 640, CV_8UC3);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const auto level = static_cast<std::uint8_t>((x * x + y * y) / 256);
      picture.at<cv::Vec3b>(y, x) = {level, level, level};
    }
  }
  return picture;
}

template <class Work>
double median_ms(const Work& work) {
  constexpr int kNumTimes = 50;
  core::Timings timings;
  work();  // warm
  for (int i = 0; i < kNumTimes; ++i) {
    const core::ScopedTimer timer(timings, "work");
    work();
  }
  return core::summarize(timings.durations_ms().at("work")).median_ms;
}

std::vector<report::Figure> describer_figures(const describe::Config& config) {
  const auto describer = describe::make_describer(config);
  const cv::Mat picture = test_picture();
  const core::FrameId frame(0);
  const double preprocess_ms = median_ms([&] { describe::preprocess(picture, config); });
  const double whole_ms = median_ms([&] { describer->describe(frame, picture); });
  const auto length = describer->describe(frame, picture).unit.size();
  const bool is_network = config.method == describe::Method::kAutoencoder;
  const bool is_hog = config.method == describe::Method::kHog;
  const std::string method = describe::kMethodNames.at(static_cast<std::size_t>(config.method));
  return {
      {"image descriptor", is_network
                               ? network::find_network("describe.network", config.network).string()
                           : is_hog ? "HOG"
                                    : method},
      {"  descriptor", fmt::format("{} numbers, describer {:016x}", length, describer->checksum())},
      {"  time", fmt::format("{:.1f} ms preprocessing + {:.1f} ms description (640x480, median of "
                             "50)",
                             preprocess_ms, whole_ms - preprocess_ms)}};
}

bool is_there(const std::string& network) {
  try {
    network::find_network("describe.network", network);
  } catch (const core::InputError&) {
    return false;
  }
  return true;
}

// HOG, and the network if it is there or asked for.
std::vector<describe::Config> describers(const describe::Config& config) {
  std::vector<describe::Config> all(1, config);
  all.front().method = describe::Method::kHog;
  if (config.method != describe::Method::kHog) {
    all.push_back(config);
  } else if (is_there(config.network)) {
    all.push_back(config);
    all.back().method = describe::Method::kAutoencoder;
  }
  return all;
}

void print(const pipeline::Config& config) {
  std::vector<report::Figure> figures = system_figures();
  try {
    for (const describe::Config& each : describers(config.describe)) {
      const auto measured = describer_figures(each);
      figures.insert(figures.end(), measured.begin(), measured.end());
    }
  } catch (const core::InputError&) {
    print_figures(figures);  // the machine is printed even if the describer cannot be made
    throw;
  }
  print_figures(figures);
}

}  // namespace

void add_doctor_command(CLI::App& app) {
  auto config = std::make_shared<ConfigOptions>();
  CLI::App* sub =
      app.add_subcommand("doctor", "Print versions, machine and speed, for a bug report");
  add_config_options(*sub, *config);
  sub->footer(
      "Examples:\n"
      "  samewhere doctor                                the speed of HOG, and of the shipped "
      "network if it is there\n"
      "  samewhere doctor --set describe.network=my.onnx that of another network");
  sub->callback([config] { print(load(*config)); });
}

}  // namespace samewhere::app
