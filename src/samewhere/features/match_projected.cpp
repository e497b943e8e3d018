#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include <samewhere/features/match_projected.hpp>

namespace samewhere::features {
namespace {

constexpr int kCell_px = 24;
constexpr int kMaxOctaveStep = 2;

std::optional<Match> best_near(const ProjectedPoint& point, const unsigned char* descriptor,
                               const Features& features, const std::vector<int>& nearby,
                               const Config& config) {
  Match best{point.row, -1, 257};
  int second_bits = 257;
  int second_octave = -1;
  for (const int i : nearby) {
    const int octave = features.octave[static_cast<std::size_t>(i)];
    if (std::abs(octave - point.octave) > kMaxOctaveStep) continue;
    const int bits = distance_bits(descriptor, features.descriptors.ptr(i));
    if (bits < best.distance_bits) {
      second_bits = best.distance_bits;
      second_octave = best.second < 0 ? -1 : features.octave[static_cast<std::size_t>(best.second)];
      best.second = i;
      best.distance_bits = bits;
    } else if (bits < second_bits) {
      second_bits = bits;
      second_octave = octave;
    }
  }
  if (best.second < 0 || best.distance_bits > config.max_distance_bits) return std::nullopt;
  // the same corner is often found on two levels: a second best on another level is no rival
  const bool has_rival = second_octave == features.octave[static_cast<std::size_t>(best.second)];
  if (has_rival && best.distance_bits > config.max_ratio * second_bits) return std::nullopt;
  return best;
}

}  // namespace

int octave_at(int octave, double described_range_m, double range_m, const Config& config) {
  const double levels = std::log(described_range_m / range_m) / std::log(config.scale_factor);
  return static_cast<int>(std::clamp(std::round(octave + levels), 0.0, config.num_levels - 1.0));
}

PixelGrid::PixelGrid(const Features& features, cv::Size image_size_px)
    : features_(features),
      num_columns_(image_size_px.width / kCell_px + 1),
      num_rows_(image_size_px.height / kCell_px + 1),
      cells_(static_cast<std::size_t>(num_columns_ * num_rows_)) {
  for (int i = 0; i < features.size(); ++i) {
    const Eigen::Vector2f& pixel = features.undistorted_px[static_cast<std::size_t>(i)];
    const int cell =
        cell_of(pixel.y(), num_rows_) * num_columns_ + cell_of(pixel.x(), num_columns_);
    cells_[static_cast<std::size_t>(cell)].push_back(i);
  }
}

int PixelGrid::cell_of(double coordinate_px, int num_cells) const {
  // undistorted pixels may lie outside the picture: they go to the cells at its edge
  return static_cast<int>(std::clamp(std::floor(coordinate_px / kCell_px), 0.0, num_cells - 1.0));
}

std::vector<int> PixelGrid::within(const Eigen::Vector2d& pixel, double radius_px) const {
  std::vector<int> found;
  const int last_row = cell_of(pixel.y() + radius_px, num_rows_);
  const int last_column = cell_of(pixel.x() + radius_px, num_columns_);
  for (int row = cell_of(pixel.y() - radius_px, num_rows_); row <= last_row; ++row) {
    for (int column = cell_of(pixel.x() - radius_px, num_columns_); column <= last_column;
         ++column) {
      for (const int i : cells_[static_cast<std::size_t>(row * num_columns_ + column)]) {
        const Eigen::Vector2d offset =
            features_.undistorted_px[static_cast<std::size_t>(i)].cast<double>() - pixel;
        if (offset.squaredNorm() <= radius_px * radius_px) found.push_back(i);
      }
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<Match> match_projected(const std::vector<ProjectedPoint>& points,
                                   const cv::Mat& point_descriptors, const View& view,
                                   double radius_px, const Config& config) {
  const Features& features = *view.features;
  const PixelGrid grid(features, view.image_size_px);
  std::vector<std::optional<Match>> of_feature(static_cast<std::size_t>(features.size()));
  for (const auto& point : points) {
    const double radius = radius_px * std::pow(config.scale_factor, point.octave);
    const auto match = best_near(point, point_descriptors.ptr(point.row), features,
                                 grid.within(point.pixel, radius), config);
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
