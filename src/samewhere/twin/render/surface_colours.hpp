#pragma once

#include <vector>

#include <samewhere/twin/building/surface.hpp>

namespace samewhere::twin {

// A colour at every point of a grid on each rectangle, interpolated between them.
class SurfaceColours {
 public:
  // Along one side of a rectangle.
  struct Axis {
    int num_points = 2;
    int coarse_step = 1;   // every so-manieth point, the last one too, makes a coarser grid
    bool is_thin = false;  // too short to differ from end to end: all points take the middle's
  };

  explicit SurfaceColours(const std::vector<Rectangle>& rectangles);

  // `right_up_m`: of a point of the rectangle, from its corner.
  Colour at(int rectangle, const Eigen::Vector2f& right_up_m) const;

  const Axis& columns(int rectangle) const { return grid(rectangle).columns; }
  const Axis& rows(int rectangle) const { return grid(rectangle).rows; }
  // Where a grid point lies, from the corner of the rectangle: a little inside of the edges, not in
  // a corner of the room.
  Eigen::Vector2f position(int rectangle, int column, int row) const;
  // Different rectangles may be written at the same time.
  Colour& value(int rectangle, int column, int row);

 private:
  struct Grid {
    Axis columns;
    Axis rows;
    std::size_t first = 0;  // of its values
    Eigen::Vector2f size_m = Eigen::Vector2f::Zero();
  };
  const Grid& grid(int rectangle) const { return grids_[static_cast<std::size_t>(rectangle)]; }

  std::vector<Grid> grids_;
  std::vector<Colour> values_;
};

}  // namespace samewhere::twin
