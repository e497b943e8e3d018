#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>

#include <samewhere/core/errors.hpp>
#include <samewhere/describe/hog.hpp>

namespace samewhere::describe {
namespace {

// Where a value falls between two neighbouring centres: `upper_share` of it belongs to lower + 1.
struct Between {
  int lower = 0;
  float upper_share = 0.0F;
};

Between between_centres(float position) {
  const float lower = std::floor(position);
  return {static_cast<int>(lower), position - lower};
}

// Pixel to cell centres; cell -1 and the one after the last are the margin outside the image.
Between cell_of_pixel(int pixel, int cell_px) {
  return between_centres((static_cast<float>(pixel) + 0.5F) / static_cast<float>(cell_px) - 0.5F);
}

// Histograms of all cells, with a margin of one cell on every side that catches the votes of border
// pixels for cells outside.
class CellGrid {
 public:
  CellGrid(int num_rows, int num_columns)
      : num_columns_(num_columns),
        bins_(static_cast<std::size_t>((num_rows + 2) * row_length()), 0.0F) {}

  int row_length() const { return (num_columns_ + 2) * kHogNumBins; }

  // Histograms of a row of cells including the margin, row in [-1, num_rows].
  std::span<float> row(int row) {
    const auto length = static_cast<std::size_t>(row_length());
    return std::span(bins_).subspan(static_cast<std::size_t>(row + 1) * length, length);
  }

  std::span<const float> cell(int row, int column) const {
    const int start = (row + 1) * row_length() + (column + 1) * kHogNumBins;
    return std::span(bins_).subspan(static_cast<std::size_t>(start), kHogNumBins);
  }

 private:
  int num_columns_;
  std::vector<float> bins_;
};

// Adds one pixel's gradient to the histograms of the two cells beside it in its row.
void vote(float dx, float dy, const Between& column, std::span<float> row_of_cells) {
  const float magnitude = std::sqrt(dx * dx + dy * dy);
  if (magnitude <= 0.0F) return;
  constexpr float kBinsPerRadian = kHogNumBins * std::numbers::inv_pi_v<float>;
  const Between bin = between_centres(std::atan2(dy, dx) * kBinsPerRadian - 0.5F);
  // opposite directions are one orientation: bins repeat after half a turn
  const int lower_bin = (bin.lower + 2 * kHogNumBins) % kHogNumBins;
  const int upper_bin = (lower_bin + 1) % kHogNumBins;
  float* left = row_of_cells.data() + static_cast<std::ptrdiff_t>(column.lower + 1) * kHogNumBins;
  float* right = left + kHogNumBins;
  const float upper_magnitude = bin.upper_share * magnitude;
  const float lower_magnitude = magnitude - upper_magnitude;
  left[lower_bin] += (1.0F - column.upper_share) * lower_magnitude;
  left[upper_bin] += (1.0F - column.upper_share) * upper_magnitude;
  right[lower_bin] += column.upper_share * lower_magnitude;
  right[upper_bin] += column.upper_share * upper_magnitude;
}

// Votes of one row of pixels. At the border the missing neighbour is the pixel itself.
void vote_row(const cv::Mat& grey, int row, const std::vector<Between>& columns,
              std::span<float> row_of_cells) {
  const int last = grey.cols - 1;
  const auto* here = grey.ptr<std::uint8_t>(row);
  const auto* above = grey.ptr<std::uint8_t>(std::max(row - 1, 0));
  const auto* below = grey.ptr<std::uint8_t>(std::min(row + 1, grey.rows - 1));
  for (int x = 0; x <= last; ++x) {
    const int dx = here[std::min(x + 1, last)] - here[std::max(x - 1, 0)];
    const int dy = below[x] - above[x];
    vote(static_cast<float>(dx), static_cast<float>(dy), columns[static_cast<std::size_t>(x)],
         row_of_cells);
  }
}

CellGrid cell_histograms(const cv::Mat& grey, int cell_px) {
  CellGrid grid(grey.rows / cell_px, grey.cols / cell_px);
  std::vector<Between> columns;
  for (int x = 0; x < grey.cols; ++x) columns.push_back(cell_of_pixel(x, cell_px));
  std::vector<float> votes(static_cast<std::size_t>(grid.row_length()));
  for (int y = 0; y < grey.rows; ++y) {
    std::fill(votes.begin(), votes.end(), 0.0F);
    vote_row(grey, y, columns, votes);
    const Between row = cell_of_pixel(y, cell_px);
    const std::span<float> upper = grid.row(row.lower);
    const std::span<float> lower = grid.row(row.lower + 1);
    for (std::size_t i = 0; i < votes.size(); ++i) {
      upper[i] += (1.0F - row.upper_share) * votes[i];
      lower[i] += row.upper_share * votes[i];
    }
  }
  return grid;
}

// L2-Hys: to unit length, no bin above kHogMaxShare, to unit length again. `floor` counts in both
// lengths like one more bin that is neither clipped nor kept: the epsilon of Dalal and Triggs.
void normalize_clipped(std::span<float> block, float floor) {
  const auto divide_by_length = [&] {
    float sum = floor * floor;
    for (const float value : block) sum += value * value;
    if (sum <= 0.0F) return;
    const float length = std::sqrt(sum);
    for (float& value : block) value /= length;
    floor /= length;
  };
  divide_by_length();
  for (float& value : block) value = std::min(value, kHogMaxShare);
  divide_by_length();
}

// Length of a block's votes if every pixel has a gradient of this magnitude, in all directions
// alike.
float length_of_even_votes(int cell_px, double gradient) {
  const double num_pixels = static_cast<double>(cell_px) * cell_px;
  constexpr double kNumCells = kHogCellsPerBlock * kHogCellsPerBlock;
  return static_cast<float>(gradient * num_pixels * std::sqrt(kNumCells / kHogNumBins));
}

}  // namespace

int hog_length(cv::Size image_px, int cell_px) {
  const int overlap = kHogCellsPerBlock - 1;
  return (image_px.width / cell_px - overlap) * (image_px.height / cell_px - overlap) *
         kHogCellsPerBlock * kHogCellsPerBlock * kHogNumBins;
}

std::vector<float> hog(const cv::Mat& grey, int cell_px, double weak_gradient) {
  core::require(grey.type() == CV_8UC1, "HOG is of 8-bit grey pixels");
  core::require(cell_px > 0 && grey.cols % cell_px == 0 && grey.rows % cell_px == 0 &&
                    std::min(grey.cols, grey.rows) >= kHogCellsPerBlock * cell_px,
                "an image for HOG is a whole number of cells and at least two each way");
  const CellGrid grid = cell_histograms(grey, cell_px);
  const float floor = length_of_even_votes(cell_px, weak_gradient);
  std::vector<float> blocks;
  blocks.reserve(static_cast<std::size_t>(hog_length(grey.size(), cell_px)));
  const auto append_block = [&](int row, int column) {
    const std::size_t start = blocks.size();
    for (int i = 0; i < kHogCellsPerBlock * kHogCellsPerBlock; ++i) {
      const auto cell = grid.cell(row + i / kHogCellsPerBlock, column + i % kHogCellsPerBlock);
      blocks.insert(blocks.end(), cell.begin(), cell.end());
    }
    normalize_clipped(std::span(blocks).subspan(start), floor);
  };
  for (int row = 0; row + kHogCellsPerBlock <= grey.rows / cell_px; ++row) {
    for (int column = 0; column + kHogCellsPerBlock <= grey.cols / cell_px; ++column) {
      append_block(row, column);
    }
  }
  return blocks;
}

}  // namespace samewhere::describe
