#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

#include <opencv2/core.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/median.hpp>
#include <samewhere/core/rectified_pair.hpp>
#include <samewhere/features/hamming.hpp>
#include <samewhere/features/match_pair.hpp>
#include <samewhere/features/pyramid.hpp>
#include <samewhere/features/stereo.hpp>
#include <samewhere/geometry/camera.hpp>

namespace samewhere::features {
namespace {

constexpr double kMinDepth_baselines = 2.0;
constexpr float kRowTolerance_px = 2.0F;  // of features of level 0
constexpr int kMaxStereoOctaveStep = 1;
constexpr int kPatchRadius_px = 5;  // of the surroundings compared
constexpr int kSearchRadius_px = 4;
constexpr int kNumSteps = 2 * kSearchRadius_px + 1;
constexpr double kMaxDifference_medians = 2.1;  // 1.4 deviations of 1.5 medians
constexpr float kMinDisparity_px = 0.05F;       // less is noise: such a point is infinitely far

// The features of a picture by the row they lie on.
class Rows {
 public:
  Rows(const Features& features, int num_rows)
      : features_(features), of_row_(static_cast<std::size_t>(num_rows)) {
    for (std::size_t i = 0; i < features.raw_px.size(); ++i) {
      of_row_[row_of(features.raw_px[i].y())].push_back(i);
    }
  }

  // The feature that looks most like this one, where its partner may be. Of equals the first.
  std::optional<std::size_t> most_similar(const Side& side, std::size_t feature,
                                          float max_disparity_px, const Config& config) const {
    const Eigen::Vector2f& pixel = side.features.raw_px[feature];
    const int octave = side.features.octave[feature];
    const auto scale = static_cast<float>(std::pow(config.scale_factor, octave));
    const float tolerance_px = kRowTolerance_px * scale;
    std::optional<std::size_t> best;
    int best_bits = config.max_distance_bits;
    for (std::size_t row = row_of(pixel.y() - tolerance_px);
         row <= row_of(pixel.y() + tolerance_px); ++row) {
      for (const std::size_t candidate : of_row_[row]) {
        const float disparity_px = pixel.x() - features_.raw_px[candidate].x();
        if (disparity_px < -scale || disparity_px > max_disparity_px) continue;
        if (std::abs(features_.octave[candidate] - octave) > kMaxStereoOctaveStep) continue;
        const int bits = distance_bits(side.features.descriptors.ptr(static_cast<int>(feature)),
                                       features_.descriptors.ptr(static_cast<int>(candidate)));
        if (bits >= best_bits) continue;
        best = candidate;
        best_bits = bits;
      }
    }
    return best;
  }

 private:
  std::size_t row_of(float y_px) const {
    const int last = static_cast<int>(of_row_.size()) - 1;
    return static_cast<std::size_t>(std::clamp(static_cast<int>(std::floor(y_px)), 0, last));
  }

  const Features& features_;
  std::vector<std::vector<std::size_t>> of_row_;
};

// Where a feature was found in the right picture, and how different its surroundings are.
struct Found {
  float right_x_px = std::numeric_limits<float>::quiet_NaN();
  double difference = 0.0;
};

cv::Mat window_around(const cv::Mat& level, int x, int y) {
  return level(cv::Rect(x - kPatchRadius_px, y - kPatchRadius_px, 2 * kPatchRadius_px + 1,
                        2 * kPatchRadius_px + 1));
}

// Offset of the lowest point of a parabola through three values whose middle one is the lowest.
double valley_offset(double before, double middle, double after) {
  const double curvature = before - 2.0 * middle + after;
  return curvature > 0.0 ? 0.5 * (before - after) / curvature : 0.0;
}

// The surroundings of `feature` in the right picture, near `guess_x_px` (full size).
std::optional<Found> slide(const Side& left, const Side& right, std::size_t feature,
                           float guess_x_px) {
  const auto octave = static_cast<std::size_t>(left.features.octave[feature]);
  const cv::Mat& left_level = left.levels[octave];
  const cv::Mat& right_level = right.levels[octave];
  const Eigen::Vector2f& left_px = left.features.raw_px[feature];
  const Eigen::Vector2f at = level_from_full(left_px, left_level, left.levels[0]);
  const Eigen::Vector2f guess =
      level_from_full({guess_x_px, left_px.y()}, left_level, left.levels[0]);
  const int x = static_cast<int>(std::lround(at.x()));
  const int y = static_cast<int>(std::lround(at.y()));
  const int first_x = static_cast<int>(std::lround(guess.x())) - kSearchRadius_px;
  if (first_x < kPatchRadius_px || first_x + kNumSteps + kPatchRadius_px > right_level.cols) {
    return std::nullopt;
  }
  const cv::Mat window = window_around(left_level, x, y);
  std::array<double, kNumSteps> differences{};
  for (int step = 0; step < kNumSteps; ++step) {
    differences[static_cast<std::size_t>(step)] =
        cv::norm(window, window_around(right_level, first_x + step, y), cv::NORM_L1);
  }
  const auto lowest = std::min_element(differences.begin(), differences.end());
  const auto step = lowest - differences.begin();
  if (step == 0 || step == kNumSteps - 1) return std::nullopt;
  const double peak_x =
      static_cast<double>(first_x + step) + valley_offset(*(lowest - 1), *lowest, *(lowest + 1));
  const double px_per_level_px = left.levels[0].cols / static_cast<double>(left_level.cols);
  return Found{left_px.x() - static_cast<float>((x - peak_x) * px_per_level_px), *lowest};
}

// Takes out what differs by far more than the median.
void remove_outliers(std::vector<Found>& found) {
  std::vector<double> differences;
  for (const auto& one : found) {
    if (!std::isnan(one.right_x_px)) differences.push_back(one.difference);
  }
  const auto median = core::median(std::move(differences));
  if (!median) return;
  const double limit = kMaxDifference_medians * *median;
  for (auto& one : found) {
    if (one.difference > limit) one = Found{};
  }
}

}  // namespace

bool is_stereo(const core::Frame& frame) {
  if (frame.images.size() < 2 || frame.rig->cameras.size() < 2 || frame.depth_m) return false;
  core::require(frame.images[0].size() == frame.images[1].size(),
                "both pictures of a stereo pair have one size");
  core::require(core::is_rectified_pair(*frame.rig),
                "stereo expects a rectified pair: equal cameras without distortion, the second "
                "displaced along x only");
  return true;
}

double baseline_m(const core::Rig& rig, const Config& config) {
  if (rig.cameras.size() < 2) return config.virtual_baseline_m;
  return (inverse(rig.body_from_camera[0]) * rig.body_from_camera[1]).translation.norm();
}

Array<float> match_stereo(const Side& left, const Side& right, const core::Rig& rig,
                          const Config& config) {
  const auto max_disparity_px =
      static_cast<float>(geometry::pinhole(rig.cameras[0]).fx_px / kMinDepth_baselines);
  const auto num_left = left.features.raw_px.size();
  std::vector<Found> found(num_left);
  if (num_left > 0) {
    const Rows rows(right.features, right.levels[0].rows);
    for (std::size_t i = 0; i < num_left; ++i) {
      const auto partner = rows.most_similar(left, i, max_disparity_px, config);
      if (!partner) continue;
      const auto placed = slide(left, right, i, right.features.raw_px[*partner].x());
      if (!placed) continue;
      const float disparity_px = left.features.raw_px[i].x() - placed->right_x_px;
      if (disparity_px >= kMinDisparity_px && disparity_px <= max_disparity_px) found[i] = *placed;
    }
  }
  remove_outliers(found);
  Array<float> right_x_px;
  right_x_px.reserve(num_left);
  for (const auto& one : found) right_x_px.push_back(one.right_x_px);
  return right_x_px;
}

}  // namespace samewhere::features
