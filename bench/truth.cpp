// truth SPEC...: is the ground truth of a twin building correct? Independent checks: reprojection
// by depth and pose, integration of inertial samples, visibility of loops and aliased pairs by
// single rays.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "carried_pixels.hpp"
#include "program.hpp"
#include <samewhere/core/grey.hpp>
#include <samewhere/core/median.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/twin/front/studio.hpp>
#include <samewhere/twin/front/walkthrough.hpp>
#include <samewhere/twin/motion/inertial.hpp>

namespace samewhere::bench {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

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
  DepthView view;
};

// Distance between the reprojection of pixels by depth and pose and their match in the other
// picture.
std::vector<double> picture_shifts_px(const core::Camera& camera, const Shot& from,
                                      const Shot& to) {
  constexpr int kStep_px = 24;
  constexpr double kHidden = 0.05;
  std::vector<double> shifts_px;
  for (const auto& pixel : carried_pixels(camera, from.view, to.view, kStep_px)) {
    if (pixel.depth_residual() > kHidden) continue;
    const auto shift_px = picture_shift(from.grey, pixel.from_px, to.grey, pixel.to_px);
    if (shift_px) shifts_px.push_back(*shift_px);
  }
  return shifts_px;
}

std::vector<double> depth_residuals(const core::Camera& camera, const Shot& from, const Shot& to) {
  constexpr int kStep_px = 12;
  std::vector<double> residuals;
  for (const auto& pixel : carried_pixels(camera, from.view, to.view, kStep_px)) {
    residuals.push_back(pixel.depth_residual());
  }
  return residuals;
}

void append(const std::vector<double>& more, std::vector<double>& values) {
  values.insert(values.end(), more.begin(), more.end());
}

// Whether both frames are there and show the same state of the building.
bool is_one_visit(const twin::Walkthrough& walk, int first, int second) {
  if (second >= walk.num_frames()) return false;
  const auto& visits = walk.walk().visit_of_frame;
  const int visit = visits[static_cast<std::size_t>(first)];
  return visit != twin::kDark && visits[static_cast<std::size_t>(second)] == visit;
}

struct Reprojection {
  std::vector<double> depth_residuals;    // between frames 1 s apart
  std::vector<double> picture_shifts_px;  // between neighbours, which look the same
};

Reprojection reprojection(const twin::Walkthrough& walk) {
  constexpr int kNumPairs = 60;
  constexpr int kApart_frames = static_cast<int>(twin::kFrameRate_hz);
  const twin::Studio studio(walk, {.ideal_depth = true});
  const core::Camera& camera = walk.rig()->cameras.front();
  const auto shot = [&](int index) {
    const twin::Pictures pictures = studio.pictures(index);
    return Shot{.grey = core::as_grey(pictures.images.front()),
                .view = {*pictures.depth_m,
                         walk.walk().poses[static_cast<std::size_t>(index)].world_from_camera}};
  };
  core::Random random(core::seed_of(walk.spec().seed, "bench.truth", 0));
  Reprojection found;
  for (int i = 0; i < kNumPairs; ++i) {
    const int first = static_cast<int>(random.index(static_cast<std::uint64_t>(walk.num_frames())));
    const int later = first + kApart_frames;
    if (!is_one_visit(walk, first, first + 1) || !is_one_visit(walk, first, later)) continue;
    const Shot from = shot(first);
    append(picture_shifts_px(camera, from, shot(first + 1)), found.picture_shifts_px);
    append(depth_residuals(camera, from, shot(later)), found.depth_residuals);
  }
  return found;
}

// "96.4 %, 0.0003 %": how many pixels are as deep as foretold, to 1 %, and the median of all.
std::string depth_agreement(const std::vector<double>& residuals) {
  const auto num_small =
      std::count_if(residuals.begin(), residuals.end(), [](double r) { return r <= 0.01; });
  const double share = static_cast<double>(num_small) /
                       static_cast<double>(std::max<std::size_t>(1, residuals.size()));
  return fmt::format("{:.1f} %, {:.4f} %", 100.0 * share,
                     100.0 * core::median(residuals).value_or(0.0));
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
  const twin::WalkTruth& truth = walk.truth();
  const Reprojection errors = reprojection(walk);
  const InertialCheck inertial = inertial_check(walk);
  // the truth was made with coarser rays: some leeway at the limits of 0.3 and 0.05
  const auto sees_the_same = [](double a, double b) { return a >= 0.25 && b >= 0.25; };
  const auto shares_nothing = [](double a, double b) { return a < 0.07 && b < 0.07; };
  const auto num_confirmable = std::count_if(truth.loops.begin(), truth.loops.end(),
                                             [](const auto& loop) { return loop.is_confirmable; });
  return {text,
          std::to_string(walk.num_frames()),
          depth_agreement(errors.depth_residuals),
          fmt::format("{:.3f}", core::median(errors.picture_shifts_px).value_or(0.0)),
          std::to_string(errors.picture_shifts_px.size()),
          fmt::format("{:.2f}", inertial.mean_chi_square),
          fmt::format("{:.1f} %", 100.0 * inertial.share_within_3_sigma),
          std::to_string(truth.loops.size()),
          std::to_string(num_confirmable),
          promise(walk, truth.loops, sees_the_same),
          std::to_string(truth.aliased_pairs.size()),
          promise(walk, truth.aliased_pairs, shares_nothing)};
}

struct Options {
  std::vector<std::string> specs;
  std::string csv_file;
};

std::function<void()> set_up(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.name("truth");
  app.description(
      "Is the ground truth of a twin building correct? Reprojection to the frame a second later "
      "by\n"
      "depth and pose: share with the predicted depth (to 1 %; the others are hidden, or an "
      "error),\n"
      "and the median residual of all; reprojection to the next frame: distance to the match in "
      "the\n"
      "picture (px, median); inertial samples integrated over 1 s; loops and aliased pairs "
      "checked\n"
      "by single rays.");
  app.add_option("SPEC", options->specs, "twin:PRESET?seed=1000")->required();
  app.add_option("--csv", options->csv_file, "write the table to this file, too");
  return [options] {
    Table table{
        {"walk", "frames", "depth as predicted, residual", "px by picture", "patches", "chi2 / dof",
         "within 3 sigma", "loops", "confirmable", "confirmed", "aliased pairs", "nothing shared"},
        {}};
    for (const auto& spec : options->specs) table.rows.push_back(check(spec));
    publish(table, options->csv_file);
  };
}

}  // namespace
}  // namespace samewhere::bench

int main(int argc, char** argv) {
  return samewhere::bench::run_program(argc, argv, samewhere::bench::set_up);
}
