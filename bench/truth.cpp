// truth SPEC...: is what the twin building says about itself true? Checks that do not go the way
// that the truth was made: pixels carried from one frame to another by depth and pose and found
// there again, inertial samples integrated, loops and impostors seen again by single rays.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "program.hpp"
#include <samewhere/core/random.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/twin/inertial.hpp>
#include <samewhere/twin/studio.hpp>
#include <samewhere/twin/walkthrough.hpp>

namespace samewhere::bench {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// How far pixels that are carried to another frame land from where they belong, pixels.
struct Reprojection {
  std::vector<double> by_depth;    // there and back again with the other frame's depth
  std::vector<double> by_picture;  // where the picture around them is found again
};

Vector3d point_at(const core::Camera& camera, const Vector2d& pixel, double depth_m) {
  const Vector3d bearing = geometry::bearing(camera, pixel);
  return bearing / bearing.z() * depth_m;
}

// Depth between the centres of pixels; nothing where surfaces meet.
std::optional<double> depth_between(const cv::Mat& depth_m, const Vector2d& pixel) {
  constexpr double kSmooth = 0.02;
  const int x = static_cast<int>(pixel.x());
  const int y = static_cast<int>(pixel.y());
  if (x < 0 || y < 0 || x + 1 >= depth_m.cols || y + 1 >= depth_m.rows) return std::nullopt;
  const double a = pixel.x() - x;
  const double b = pixel.y() - y;
  // inverse depth is linear on a plane
  const double corners[4] = {1.0 / depth_m.at<float>(y, x), 1.0 / depth_m.at<float>(y, x + 1),
                             1.0 / depth_m.at<float>(y + 1, x),
                             1.0 / depth_m.at<float>(y + 1, x + 1)};
  const auto [low, high] = std::minmax_element(std::begin(corners), std::end(corners));
  if (!(*high < (1.0 + kSmooth) * *low)) return std::nullopt;
  return 1.0 / ((1 - b) * ((1 - a) * corners[0] + a * corners[1]) +
                b * ((1 - a) * corners[2] + a * corners[3]));
}

// Shift of the second picture's patch over the first's, by phase correlation; nothing if the patch
// holds too little to tell.
std::optional<double> picture_shift(const cv::Mat& first, const Vector2d& at_first,
                                    const cv::Mat& second, const Vector2d& at_second) {
  constexpr int kSide = 32;
  constexpr double kMinDeviation = 6.0;
  constexpr double kMinResponse = 0.5;
  cv::Mat a;
  cv::Mat b;
  const cv::Size size(kSide, kSide);
  cv::getRectSubPix(first, size,
                    {static_cast<float>(at_first.x()), static_cast<float>(at_first.y())}, a);
  cv::getRectSubPix(second, size,
                    {static_cast<float>(at_second.x()), static_cast<float>(at_second.y())}, b);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(a, mean, deviation);
  if (deviation[0] < kMinDeviation) return std::nullopt;
  a.convertTo(a, CV_64F);
  b.convertTo(b, CV_64F);
  cv::Mat window;
  cv::createHanningWindow(window, size, CV_64F);
  double response = 0.0;
  const cv::Point2d shift = cv::phaseCorrelate(a, b, window, &response);
  if (response < kMinResponse) return std::nullopt;
  return std::hypot(shift.x, shift.y);
}

struct Shot {
  cv::Mat grey;
  cv::Mat depth_m;
  core::Rigid3 world_from_camera;
};

void carry(const core::Camera& camera, const Shot& from, const Shot& to, Reprojection& errors) {
  constexpr int kStep_px = 24;
  const core::Rigid3 to_from_from = inverse(to.world_from_camera) * from.world_from_camera;
  for (int y = kStep_px; y + kStep_px < from.grey.rows; y += kStep_px) {
    for (int x = kStep_px; x + kStep_px < from.grey.cols; x += kStep_px) {
      const double depth_m = from.depth_m.at<float>(y, x);
      if (depth_m <= 0.0) continue;
      const Vector3d in_to = to_from_from * point_at(camera, {x, y}, depth_m);
      const auto pixel = geometry::project(camera, in_to);
      if (!pixel) continue;
      const auto seen_m = depth_between(to.depth_m, *pixel);
      if (!seen_m || std::abs(*seen_m - in_to.z()) > 0.05 * in_to.z()) continue;  // hidden there
      const Vector3d back = inverse(to_from_from) * point_at(camera, *pixel, *seen_m);
      if (const auto again = geometry::project(camera, back)) {
        errors.by_depth.push_back((*again - Vector2d(x, y)).norm());
      }
      if (const auto shift = picture_shift(from.grey, Vector2d(x, y), to.grey, *pixel)) {
        errors.by_picture.push_back(*shift);
      }
    }
  }
}

Reprojection reprojection(const twin::Walkthrough& walk, const twin::WalkTruth& truth) {
  constexpr int kNumPairs = 60;
  twin::Config config;
  config.ideal_depth = true;
  const twin::Studio studio(walk, config);
  const core::Camera& camera = walk.rig()->cameras.front();
  const auto shot = [&](int index) {
    const twin::Pictures pictures = studio.pictures(index);
    Shot taken{.grey = {}, .depth_m = *pictures.depth_m, .world_from_camera = {}};
    cv::cvtColor(pictures.images.front(), taken.grey, cv::COLOR_BGR2GRAY);
    taken.world_from_camera = walk.walk().poses[static_cast<std::size_t>(index)].world_from_camera;
    return taken;
  };
  core::Random random(core::seed_of(walk.spec().seed, "bench.truth", 0));
  Reprojection errors;
  for (int i = 0; i < kNumPairs; ++i) {
    const int first =
        static_cast<int>(random.index(static_cast<std::uint64_t>(walk.num_frames() - 1)));
    const int visit = walk.walk().visit_of_frame[static_cast<std::size_t>(first)];
    if (visit == twin::kDark ||
        walk.walk().visit_of_frame[static_cast<std::size_t>(first) + 1] != visit)
      continue;
    carry(camera, shot(first), shot(first + 1), errors);
  }
  for (int i = 0; i < kNumPairs && !truth.loops.empty(); ++i) {
    const auto& loop = truth.loops[random.index(truth.loops.size())];
    Reprojection again;  // light and view may have changed: the pictures are not compared
    carry(camera, shot(loop.query), shot(loop.match), again);
    errors.by_depth.insert(errors.by_depth.end(), again.by_depth.begin(), again.by_depth.end());
  }
  return errors;
}

struct InertialCheck {
  double mean_chi_square = 0.0;  // of a pose over its six degrees of freedom; 1 is right
  double share_within_3_sigma = 0.0;
};

InertialCheck inertial_check(const twin::Walkthrough& walk) {
  constexpr double kWindow_s = 1.0;
  const std::uint64_t seed = core::seed_of(walk.spec().seed, "twin.imu", 0);
  const twin::InertialNoise noise;
  const auto samples = twin::inertial_samples(walk.motion(), noise, seed);
  const auto biases = twin::inertial_biases(walk.motion(), noise, seed);
  const auto per_window = static_cast<std::size_t>(kWindow_s * twin::kImuRate_hz);
  double sum = 0.0;
  int num_values = 0;
  int num_within = 0;
  for (std::size_t i = 0; i + per_window < samples.size(); i += per_window) {
    const twin::InertialState start =
        twin::true_state(walk.motion(), samples[i].stamp_s, biases[i]);
    const double end_s = samples[i + per_window].stamp_s;
    const twin::InertialState end = twin::integrated(start, samples, noise, end_s);
    const core::Vector6d error =
        twin::pose_error(end.world_from_body, walk.motion().world_from_body(end_s));
    const Eigen::Array<double, 6, 1> ratio = error.array() / end.pose_sigma().array();
    sum += ratio.square().sum();
    num_within += static_cast<int>((ratio.abs() <= 3.0).count());
    num_values += 6;
  }
  return {sum / num_values, static_cast<double>(num_within) / num_values};
}

// Share of what one frame sees that another sees too, by single rays: it lies in the other's
// picture and nothing stands between.
double overlap_by_rays(const twin::Walkthrough& walk, int query, int match) {
  constexpr int kNumColumns = 32;
  constexpr int kNumRows = 24;
  const core::Camera& camera = walk.rig()->cameras.front();
  const core::PinholeRadtan& c = geometry::pinhole(camera);
  const auto& poses = walk.walk().poses;
  const core::Rigid3& from = poses[static_cast<std::size_t>(query)].world_from_camera;
  const core::Rigid3& to = poses[static_cast<std::size_t>(match)].world_from_camera;
  const auto visit_of = [&](int frame) {
    return walk.visits()[static_cast<std::size_t>(
        walk.walk().visit_of_frame[static_cast<std::size_t>(frame)])];
  };
  int num_seen = 0;
  int num_shared = 0;
  for (int row = 0; row < kNumRows; ++row) {
    for (int column = 0; column < kNumColumns; ++column) {
      const Vector2d pixel((column + 0.5) * c.width_px / kNumColumns - 0.5,
                           (row + 0.5) * c.height_px / kNumRows - 0.5);
      const twin::Ray ray{from.translation.cast<float>(),
                          (from.rotation * geometry::bearing(camera, pixel)).cast<float>()};
      const auto hit = visit_of(query).rays->first_hit(ray);
      if (!hit) continue;
      ++num_seen;
      const Vector3d point = (ray.origin + hit->reach * ray.direction).cast<double>();
      const Vector3d in_match = inverse(to) * point;
      const auto at = geometry::project(camera, in_match);
      if (!at || at->x() < -0.5 || at->y() < -0.5 || at->x() > c.width_px - 0.5 ||
          at->y() > c.height_px - 0.5)
        continue;
      const twin::Ray back{to.translation.cast<float>(), (point - to.translation).cast<float>()};
      const auto first = visit_of(match).rays->first_hit(back);
      const double tolerance = (0.05 + 0.04 * in_match.z()) / in_match.z();
      if (first && std::abs(first->reach - 1.0) <= tolerance) ++num_shared;
    }
  }
  return num_seen == 0 ? 0.0 : static_cast<double>(num_shared) / num_seen;
}

// Of up to 300 pairs: how many keep the promise that both ways' overlap is at least / below a
// limit.
template <class Pairs, class Keeps>
std::string promise(const twin::Walkthrough& walk, const Pairs& pairs, const Keeps& keeps) {
  constexpr std::size_t kMost = 300;
  const std::size_t step = std::max<std::size_t>(1, pairs.size() / kMost);
  int num_asked = 0;
  int num_kept = 0;
  for (std::size_t i = 0; i < pairs.size(); i += step) {
    ++num_asked;
    num_kept += static_cast<int>(keeps(overlap_by_rays(walk, pairs[i].query, pairs[i].match),
                                       overlap_by_rays(walk, pairs[i].match, pairs[i].query)));
  }
  return fmt::format("{} of {}", num_kept, num_asked);
}

std::vector<std::string> check(const std::string& text) {
  const twin::Walkthrough walk(twin::parse_spec(text), {});
  const twin::WalkTruth truth = walk.truth();
  const Reprojection errors = reprojection(walk, truth);
  const InertialCheck inertial = inertial_check(walk);
  // the truth was made with coarser rays: some leeway at the limits of 0.3 and 0.05
  const auto sees_the_same = [](double a, double b) { return a >= 0.25 && b >= 0.25; };
  const auto shares_nothing = [](double a, double b) { return a < 0.07 && b < 0.07; };
  const auto num_confirmable = std::count_if(truth.loops.begin(), truth.loops.end(),
                                             [](const auto& loop) { return loop.is_confirmable; });
  return {text,
          std::to_string(walk.num_frames()),
          fmt::format("{:.4f}", median(errors.by_depth)),
          fmt::format("{:.3f}", median(errors.by_picture)),
          std::to_string(errors.by_picture.size()),
          fmt::format("{:.2f}", inertial.mean_chi_square),
          fmt::format("{:.1f} %", 100.0 * inertial.share_within_3_sigma),
          std::to_string(truth.loops.size()),
          std::to_string(num_confirmable),
          promise(walk, truth.loops, sees_the_same),
          std::to_string(truth.impostors.size()),
          promise(walk, truth.impostors, shares_nothing)};
}

int run(int argc, char** argv) {
  std::vector<std::string> specs;
  std::string csv_file;
  CLI::App app(
      "Is what the twin building says about itself true? Pixels carried to another frame by depth "
      "and\n"
      "pose: how far from there and back again, and from where the picture is found again (px, "
      "median);\n"
      "inertial samples integrated over 1 s; loops and impostors seen again by single rays.",
      "truth");
  app.add_option("SPEC", specs, "twin:PRESET?seed=1000")->required();
  app.add_option("--csv", csv_file, "write the table to this file, too");
  return run_program(app, argc, argv, [&] {
    Table table{
        {"walk", "frames", "px by depth", "px by picture", "patches", "chi2 / dof",
         "within 3 sigma", "loops", "confirmable", "seen again", "impostors", "nothing shared"},
        {}};
    for (const auto& spec : specs) table.rows.push_back(check(spec));
    publish(table, csv_file);
  });
}

}  // namespace
}  // namespace samewhere::bench

int main(int argc, char** argv) {
  try {
    return samewhere::bench::run(argc, argv);
  } catch (...) {
    return samewhere::bench::kBrokenPromise;  // not even the options could be set up
  }
}
