#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>

#include <opencv2/core/hal/intrin.hpp>
#include <opencv2/features2d.hpp>

#include <samewhere/features/corners.hpp>
#include <samewhere/features/pyramid.hpp>

namespace samewhere::features {
namespace {

constexpr int kClearContrast = 20;  // FAST threshold that finds enough where there is much to see
constexpr std::size_t kEnoughPerCell = 3;  // clear corners that make a second search needless
constexpr int kSurePerCell = 2;      // corners that each part of the picture gives before others
constexpr int kFastRadius_px = 3;    // of the circle that FAST looks at
constexpr int kTensorRadius_px = 3;  // of the window that the structure tensor is summed over

// The lanes of a row of the window: seven pixels, the eighth does not count.
cv::v_int16x8 window_lanes() { return {-1, -1, -1, -1, -1, -1, -1, 0}; }

cv::v_int16x8 eight_pixels(const std::uint8_t* first) {
  return cv::v_reinterpret_as_s16(cv::v_load_expand(first));
}

// Smaller eigenvalue of the sum of the products of gradients, grey levels squared. Whole numbers up
// to the root: the same on every machine.
float strength_at(const cv::Mat& image, int x, int y) {
  const cv::v_int16x8 lanes = window_lanes();
  cv::v_int32x4 xx = cv::v_setzero_s32();
  cv::v_int32x4 xy = cv::v_setzero_s32();
  cv::v_int32x4 yy = cv::v_setzero_s32();
  for (int row = y - kTensorRadius_px; row <= y + kTensorRadius_px; ++row) {
    const std::uint8_t* here = image.ptr(row) + x - kTensorRadius_px;
    const cv::v_int16x8 dx = (eight_pixels(here + 1) - eight_pixels(here - 1)) & lanes;
    const cv::v_int16x8 dy =
        (eight_pixels(here + image.step) - eight_pixels(here - image.step)) & lanes;
    xx += cv::v_dotprod(dx, dx);
    xy += cv::v_dotprod(dx, dy);
    yy += cv::v_dotprod(dy, dy);
  }
  const auto sum_xx = static_cast<float>(cv::v_reduce_sum(xx));
  const auto sum_xy = static_cast<float>(cv::v_reduce_sum(xy));
  const auto sum_yy = static_cast<float>(cv::v_reduce_sum(yy));
  const float half_difference = 0.5F * (sum_xx - sum_yy);
  return 0.5F * (sum_xx + sum_yy) - std::sqrt(half_difference * half_difference + sum_xy * sum_xy);
}

// Where the parabola through three neighbouring values is highest, from the middle one.
float peak_offset(float before, float middle, float after) {
  const float curvature = before - 2.0F * middle + after;
  if (curvature >= 0.0F) return 0.0F;
  return std::clamp(0.5F * (before - after) / curvature, -0.5F, 0.5F);
}

// FAST corners whose centre lies within `inside`.
std::vector<cv::KeyPoint> fast_within(const cv::Mat& image, const cv::Rect& inside, int contrast) {
  const cv::Rect seen(inside.x - kFastRadius_px, inside.y - kFastRadius_px,
                      inside.width + 2 * kFastRadius_px, inside.height + 2 * kFastRadius_px);
  std::vector<cv::KeyPoint> found;
  cv::FAST(image(seen), found, contrast);
  for (auto& keypoint : found) {
    keypoint.pt.x += static_cast<float>(seen.x);
    keypoint.pt.y += static_cast<float>(seen.y);
  }
  return found;
}

// A grid of cells over a rectangle.
struct Grid {
  cv::Rect area;
  int cell_px = 0;

  int num_columns() const { return (area.width + cell_px - 1) / cell_px; }
  int num_rows() const { return (area.height + cell_px - 1) / cell_px; }
  int cell_of(const cv::Point2f& pixel) const {
    return (static_cast<int>(pixel.y) - area.y) / cell_px * num_columns() +
           (static_cast<int>(pixel.x) - area.x) / cell_px;
  }
  cv::Rect cell(int number) const {
    const cv::Point corner(area.x + number % num_columns() * cell_px,
                           area.y + number / num_columns() * cell_px);
    return cv::Rect(corner, cv::Size(cell_px, cell_px)) & area;
  }
};

bool is_stronger(const Corner& a, const Corner& b) {
  if (a.strength != b.strength) return a.strength > b.strength;
  return std::tuple(a.level, a.level_px.y(), a.level_px.x()) <
         std::tuple(b.level, b.level_px.y(), b.level_px.x());
}

// Which turn a corner has among those of its part of the picture, as they come, strongest first:
// some go before all others, the rest by their turn among those of their level.
class Turns {
 public:
  explicit Turns(const Config& config) {
    for (const double scale : level_scales(config)) {
      cell_px_of_level_.push_back(static_cast<float>(config.cell_px / scale));
    }
  }

  int next_of(const Corner& corner) {
    const auto level = static_cast<std::size_t>(corner.level);
    Cell& cell = cell_of(corner.level_px / cell_px_of_level_[level]);
    const int of_level = cell.num_of_level[level]++;
    const int of_cell = cell.num++;
    return of_cell < kSurePerCell ? of_cell : kSurePerCell + of_level;
  }

 private:
  struct Cell {
    int num = 0;
    std::vector<int> num_of_level;
  };

  Cell& cell_of(const Eigen::Vector2f& pixel_in_cells) {
    const auto row = static_cast<std::size_t>(pixel_in_cells.y());
    const auto column = static_cast<std::size_t>(pixel_in_cells.x());
    if (row >= rows_.size()) rows_.resize(row + 1);
    if (column >= rows_[row].size()) {
      rows_[row].resize(column + 1, {0, std::vector<int>(cell_px_of_level_.size(), 0)});
    }
    return rows_[row][column];
  }

  std::vector<float> cell_px_of_level_;
  std::vector<std::vector<Cell>> rows_;
};

}  // namespace

std::vector<Corner> find_corners(const cv::Mat& image, int level, const Config& config) {
  const Grid grid{
      {kBorder_px, kBorder_px, image.cols - 2 * kBorder_px, image.rows - 2 * kBorder_px},
      config.cell_px};
  const int clear_contrast = std::max(kClearContrast, config.min_corner_contrast);
  std::vector<std::vector<cv::KeyPoint>> of_cell(
      static_cast<std::size_t>(grid.num_columns() * grid.num_rows()));
  for (const auto& keypoint : fast_within(image, grid.area, clear_contrast)) {
    of_cell[static_cast<std::size_t>(grid.cell_of(keypoint.pt))].push_back(keypoint);
  }
  std::vector<Corner> corners;
  for (std::size_t i = 0; i < of_cell.size(); ++i) {
    if (of_cell[i].size() < kEnoughPerCell && config.min_corner_contrast < clear_contrast) {
      of_cell[i] = fast_within(image, grid.cell(static_cast<int>(i)), config.min_corner_contrast);
    }
    for (const auto& keypoint : of_cell[i]) {
      const int x = static_cast<int>(keypoint.pt.x);
      const int y = static_cast<int>(keypoint.pt.y);
      corners.push_back({{keypoint.pt.x, keypoint.pt.y}, level, strength_at(image, x, y)});
    }
  }
  return corners;
}

std::vector<Corner> spread_evenly(std::vector<Corner> corners, const Config& config) {
  std::sort(corners.begin(), corners.end(),
            [](const Corner& a, const Corner& b) { return is_stronger(a, b); });
  Turns turns(config);
  std::vector<std::vector<Corner>> of_turn;
  for (const Corner& corner : corners) {
    const auto turn = static_cast<std::size_t>(turns.next_of(corner));
    if (turn >= of_turn.size()) of_turn.resize(turn + 1);
    of_turn[turn].push_back(corner);
  }
  std::vector<Corner> spread;
  for (const auto& same_turn : of_turn) {
    for (const Corner& corner : same_turn) {
      if (spread.size() == static_cast<std::size_t>(config.num_features)) return spread;
      spread.push_back(corner);
    }
  }
  return spread;
}

Corner with_subpixel(const cv::Mat& image, const Corner& corner) {
  const int x = static_cast<int>(corner.level_px.x());
  const int y = static_cast<int>(corner.level_px.y());
  Corner moved = corner;
  moved.level_px.x() +=
      peak_offset(strength_at(image, x - 1, y), corner.strength, strength_at(image, x + 1, y));
  moved.level_px.y() +=
      peak_offset(strength_at(image, x, y - 1), corner.strength, strength_at(image, x, y + 1));
  return moved;
}

}  // namespace samewhere::features
