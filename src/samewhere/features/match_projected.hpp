#pragma once

#include <vector>

#include <Eigen/Core>

#include <samewhere/features/features.hpp>
#include <samewhere/features/match_pair.hpp>

namespace samewhere::features {

// The features of a picture, sorted into cells, to find those near a pixel.
class PixelGrid {
 public:
  // `features` outlive it. Pixels may lie anywhere or be NaN, and the size may be that of no
  // picture.
  PixelGrid(const Features& features, cv::Size image_size_px);

  const Features& features() const { return features_; }

  // Calls visit(index) for each feature whose undistorted pixel lies within `radius_px` of `pixel`,
  // cell by cell.
  template <class Visit>
  void visit_within(const Eigen::Vector2d& pixel, double radius_px, const Visit& visit) const {
    const int first_column = cell_of(pixel.x() - radius_px, num_columns_);
    const int last_column = cell_of(pixel.x() + radius_px, num_columns_);
    const int last_row = cell_of(pixel.y() + radius_px, num_rows_);
    for (int row = cell_of(pixel.y() - radius_px, num_rows_); row <= last_row; ++row) {
      // the cells of a row lie one after the other
      const std::size_t first = cell_at(row, first_column);
      const std::size_t last = cell_at(row, last_column);
      for (std::size_t i = first_of_cell_[first]; i < first_of_cell_[last + 1]; ++i) {
        const Eigen::Vector2d offset = placed_[i].pixel.template cast<double>() - pixel;
        if (offset.squaredNorm() <= radius_px * radius_px) visit(placed_[i].index);
      }
    }
  }

 private:
  struct Placed {
    Eigen::Vector2f pixel;
    int index = 0;
  };

  static int cell_of(double coordinate_px, int num_cells);
  std::size_t cell_at(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(num_columns_) +
           static_cast<std::size_t>(column);
  }

  const Features& features_;
  int num_columns_;
  int num_rows_;
  std::vector<std::size_t> first_of_cell_;  // into placed_, and one more: its size
  std::vector<Placed> placed_;              // cell by cell, row by row
};

// A point of the map and where it should appear.
struct ProjectedPoint {
  int row = 0;            // of its descriptor in the table
  Eigen::Vector2d pixel;  // undistorted
  int octave = 0;         // level on which it was seen first
};

// The pyramid level on which a point appears from range_m that was seen on `octave` from
// described_range_m: twice as near, it is twice as large. Within the levels that there are.
int octave_at(int octave, double described_range_m, double range_m, const Config& config);

// For each point the feature near its projection that looks most like it: not further than
// radius_px * scale^octave, at most two levels away, clearly nearer than the second best on the
// same level. A feature goes to the point nearest in appearance. Match{first = row of the point,
// second = feature}, ascending in `second`.
std::vector<Match> match_projected(const std::vector<ProjectedPoint>& points,
                                   const cv::Mat& point_descriptors, const View& view,
                                   double radius_px, const Config& config);

}  // namespace samewhere::features
