#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include <samewhere/features/hamming.hpp>
#include <samewhere/features/match_projected.hpp>
#include <samewhere/features/pyramid.hpp>

namespace samewhere::features {
namespace {

constexpr int kCell_px = 24;
constexpr int kMaxOctaveStep = 2;

// A feature by how much it looks like a point; ties go to the feature with the lower index, so that
// the order in which they are looked at does not matter.
struct Alike {
  int distance_bits = 257;
  int feature = -1;

  bool operator<(const Alike& other) const {
    return std::tie(distance_bits, feature) < std::tie(other.distance_bits, other.feature);
  }
};

std::optional<Match> best_near(const ProjectedPoint& point, const unsigned char* descriptor,
                               const PixelGrid& grid, double radius_px, const Config& config) {
  const Features& features = grid.features();
  const auto octave_of = [&](int feature) {
    return features.octave[static_cast<std::size_t>(feature)];
  };
  Alike best;
  Alike second;
  grid.visit_within(point.pixel, radius_px, [&](int i) {
    if (std::abs(octave_of(i) - point.octave) > kMaxOctaveStep) return;
    const Alike one{distance_bits(descriptor, features.descriptors.ptr(i)), i};
    if (one < best) {
      second = std::exchange(best, one);
    } else if (one < second) {
      second = one;
    }
  });
  if (best.feature < 0 || best.distance_bits > config.max_distance_bits) return std::nullopt;
  // the same corner is often found on two levels: a second best on another level does not make the
  // match ambiguous
  const bool is_contested =
      second.feature >= 0 && octave_of(second.feature) == octave_of(best.feature);
  if (is_contested && best.distance_bits > config.max_ratio * second.distance_bits) {
    return std::nullopt;
  }
  return Match{point.row, best.feature, best.distance_bits};
}

// Along a side. What is larger than any picture goes to the last cell.
int num_cells(int side_px) {
  constexpr int kMaxCells = 65536 / kCell_px;
  return std::clamp(side_px / kCell_px, 0, kMaxCells) + 1;
}

}  // namespace

int octave_at(int octave, double described_range_m, double range_m, const Config& config) {
  const double levels = std::log(described_range_m / range_m) / std::log(config.scale_factor);
  if (std::isnan(levels)) return std::clamp(octave, 0, config.num_levels - 1);
  return static_cast<int>(std::clamp(std::round(octave + levels), 0.0, config.num_levels - 1.0));
}

PixelGrid::PixelGrid(const Features& features, cv::Size image_size_px)
    : features_(features),
      num_columns_(num_cells(image_size_px.width)),
      num_rows_(num_cells(image_size_px.height)),
      first_of_cell_(cell_at(num_rows_, 0) + 1, 0),
      placed_(features.undistorted_px.size()) {
  const auto cell_with = [&](const Eigen::Vector2f& pixel) {
    return cell_at(cell_of(pixel.y(), num_rows_), cell_of(pixel.x(), num_columns_));
  };
  for (const auto& pixel : features.undistorted_px) ++first_of_cell_[cell_with(pixel) + 1];
  std::partial_sum(first_of_cell_.begin(), first_of_cell_.end(), first_of_cell_.begin());
  std::vector<std::size_t> next(first_of_cell_.begin(), first_of_cell_.end() - 1);
  for (int i = 0; i < features.size(); ++i) {
    const Eigen::Vector2f& pixel = features.undistorted_px[static_cast<std::size_t>(i)];
    placed_[next[cell_with(pixel)]++] = {pixel, i};
  }
}

// Undistorted pixels may lie outside the picture: they go to the cells at its edge, those that are
// no number to the first.
int PixelGrid::cell_of(double coordinate_px, int num_cells) {
  if (std::isnan(coordinate_px)) return 0;
  return static_cast<int>(std::clamp(coordinate_px / kCell_px, 0.0, num_cells - 1.0));
}

std::vector<Match> match_projected(const std::vector<ProjectedPoint>& points,
                                   const cv::Mat& point_descriptors, const View& view,
                                   double radius_px, const Config& config) {
  const Features& features = *view.features;
  const PixelGrid grid(features, view.image_size_px);
  const std::vector<double> scales = level_scales(config);
  std::vector<std::optional<Match>> of_feature(static_cast<std::size_t>(features.size()));
  for (const auto& point : points) {
    const double radius = radius_px * scales[static_cast<std::size_t>(point.octave)];
    const auto match = best_near(point, point_descriptors.ptr(point.row), grid, radius, config);
    if (!match) continue;
    auto& holder = of_feature[static_cast<std::size_t>(match->second)];
    if (!holder || match->distance_bits < holder->distance_bits) holder = match;
  }
  std::vector<Match> matches;
  for (const auto& match : of_feature) {
    if (match) matches.push_back(*match);
  }
  return matches;
}

}  // namespace samewhere::features
