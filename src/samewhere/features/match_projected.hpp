#pragma once

#include <vector>

#include <Eigen/Core>

#include <samewhere/features/features.hpp>
#include <samewhere/features/match_pair.hpp>

namespace samewhere::features {

// The features of a picture, sorted into cells, to find those near a pixel.
class PixelGrid {
 public:
  PixelGrid(const Features& features, cv::Size image_size_px);

  // Indices of the features whose undistorted pixel lies within `radius_px` of `pixel`, ascending.
  std::vector<int> within(const Eigen::Vector2d& pixel, double radius_px) const;

 private:
  int cell_of(double coordinate_px, int num_cells) const;

  const Features& features_;
  int num_columns_;
  int num_rows_;
  std::vector<std::vector<int>> cells_;
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
