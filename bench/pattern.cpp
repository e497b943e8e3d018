// pattern SOURCE...: which 256 comparisons of pixels tell corners apart best?
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "program.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/grey.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/features/corners.hpp>
#include <samewhere/features/describe.hpp>
#include <samewhere/features/pyramid.hpp>
#include <samewhere/run/open_source.hpp>

namespace samewhere::bench {
namespace {

constexpr int kNumTests = 8 * features::kDescriptorBytes;
constexpr int kNumCandidates = 40'000;
constexpr int kCornersPerPicture = 150;
constexpr int kRadius_px = features::kPatchRadius_px;
constexpr int kSide_px = 2 * kRadius_px + 1;

struct Options {
  std::vector<std::string> sources;
  int num_frames = 100;
};

// The surroundings of a corner, turned upright.
using Patch = std::array<std::uint8_t, static_cast<std::size_t>(kSide_px* kSide_px)>;

// A comparison of two pixels of a patch.
struct Test {
  cv::Point a;
  cv::Point b;
};

std::size_t index_of(const cv::Point& offset) {
  return static_cast<std::size_t>((offset.y + kRadius_px) * kSide_px + offset.x + kRadius_px);
}

bool is_in_disc(const cv::Point& offset) { return offset.dot(offset) <= kRadius_px * kRadius_px; }

Patch patch_at(const cv::Mat& blurred, const Eigen::Vector2f& pixel, float angle_rad) {
  const Eigen::Rotation2Df turn(angle_rad);
  Patch patch{};
  for (int y = -kRadius_px; y <= kRadius_px; ++y) {
    for (int x = -kRadius_px; x <= kRadius_px; ++x) {
      if (!is_in_disc({x, y})) continue;
      const Eigen::Vector2f at =
          pixel + turn * Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y));
      patch[index_of({x, y})] = blurred.at<std::uint8_t>(static_cast<int>(std::lround(at.y())),
                                                         static_cast<int>(std::lround(at.x())));
    }
  }
  return patch;
}

void add_patches(const cv::Mat& grey, std::vector<Patch>& patches) {
  const features::Config config{.num_features = kCornersPerPicture};
  const std::vector<cv::Mat> levels = features::pyramid(grey, config);
  std::vector<features::Corner> corners;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const auto found = features::find_corners(levels[i], static_cast<int>(i), config);
    corners.insert(corners.end(), found.begin(), found.end());
  }
  for (const auto& corner : features::spread_evenly(corners, config)) {
    const cv::Mat& level = levels[static_cast<std::size_t>(corner.level)];
    const float angle_rad = features::orientation_rad(level, corner.level_px);
    patches.push_back(
        patch_at(features::blurred_for_descriptors(level), corner.level_px, angle_rad));
  }
}

std::vector<Patch> patches_of(const Options& options) {
  std::vector<Patch> patches;
  for (const std::string& name : options.sources) {
    pipeline::Config config = pipeline::profile("default");
    config.source = run::absolute_source(name);
    const auto source = run::open_source(config);
    const int step = std::max(1, source->info().num_frames / options.num_frames);
    for (int i = 0; const auto frame = source->next(); ++i) {
      core::stop_if_interrupted();
      if (i % step == 0) add_patches(core::as_grey(frame->images.front()), patches);
    }
  }
  return patches;
}

// A test and its answers on all patches, one bit each.
struct Candidate {
  Test test;
  std::vector<std::uint64_t> answers;
  double mean = 0.0;
};

Candidate tried(const Test& test, const std::vector<Patch>& patches) {
  Candidate candidate{test, std::vector<std::uint64_t>(patches.size() / 64 + 1)};
  int num_true = 0;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const bool is_darker = patches[i][index_of(test.a)] < patches[i][index_of(test.b)];
    candidate.answers[i / 64] |= static_cast<std::uint64_t>(is_darker) << (i % 64);
    num_true += is_darker ? 1 : 0;
  }
  candidate.mean = num_true / static_cast<double>(patches.size());
  return candidate;
}

cv::Point drawn_offset(core::Random& random) {
  while (true) {
    const cv::Point offset(static_cast<int>(random.index(kSide_px)) - kRadius_px,
                           static_cast<int>(random.index(kSide_px)) - kRadius_px);
    if (is_in_disc(offset)) return offset;
  }
}

// Those whose answer is least foreseeable first.
std::vector<Candidate> candidates(const std::vector<Patch>& patches) {
  core::Random random(1);
  std::vector<Candidate> all;
  while (all.size() < kNumCandidates) {
    core::stop_if_interrupted();
    const cv::Point a = drawn_offset(random);
    const cv::Point b = drawn_offset(random);
    if (a != b) all.push_back(tried({a, b}, patches));
  }
  std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
    return std::abs(a.mean - 0.5) < std::abs(b.mean - 0.5);
  });
  return all;
}

double correlation(const Candidate& a, const Candidate& b, std::size_t num_patches) {
  int num_both = 0;
  for (std::size_t i = 0; i < a.answers.size(); ++i) {
    num_both += std::popcount(a.answers[i] & b.answers[i]);
  }
  const double covariance = num_both / static_cast<double>(num_patches) - a.mean * b.mean;
  return covariance / std::sqrt(a.mean * (1.0 - a.mean) * b.mean * (1.0 - b.mean));
}

// Rublee et al. 2011, section 4.3: in the order of the list, those that are not correlated with any
// taken before by more than a limit, which is raised until there are enough.
std::vector<Test> chosen(const std::vector<Candidate>& all, std::size_t num_patches) {
  for (double limit = 0.1; limit < 1.0; limit += 0.02) {
    std::vector<const Candidate*> taken;
    for (const auto& candidate : all) {
      const bool is_new = std::none_of(taken.begin(), taken.end(), [&](const Candidate* other) {
        return std::abs(correlation(candidate, *other, num_patches)) > limit;
      });
      if (is_new) taken.push_back(&candidate);
      if (taken.size() < kNumTests) continue;
      std::vector<Test> tests;
      for (const Candidate* test : taken) tests.push_back(test->test);
      return tests;
    }
  }
  throw core::InputError("too few pictures: no 256 tests are different from each other");
}

void learn(const Options& options) {
  const std::vector<Patch> patches = patches_of(options);
  for (const Test& test : chosen(candidates(patches), patches.size())) {
    fmt::print("{{{}, {}, {}, {}}},\n", test.a.x, test.a.y, test.b.x, test.b.y);
  }
}

std::function<void()> set_up(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  app.name("pattern");
  app.description(
      "Chooses the comparisons of pixels that a descriptor is made of, so that on the corners of\n"
      "these pictures each is true as often as not and no two say the same. Prints them as\n"
      "src/samewhere/features/pattern.hpp holds them.");
  app.add_option("SOURCE", options->sources, "recordings and twin: buildings")->required();
  app.add_option("--frames", options->num_frames, "so many of each source, evenly spaced")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  return [options] { learn(*options); };
}

}  // namespace
}  // namespace samewhere::bench

int main(int argc, char** argv) {
  return samewhere::bench::run_program(argc, argv, samewhere::bench::set_up);
}
