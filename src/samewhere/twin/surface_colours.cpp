#include <algorithm>
#include <cmath>

#include <samewhere/twin/surface_colours.hpp>

namespace samewhere::twin {
namespace {

constexpr float kGridStep_m = 0.1F;

}  // namespace

SurfaceColours::SurfaceColours(const std::vector<Rectangle>& rectangles) {
  std::size_t num_values = 0;
  for (const auto& r : rectangles) {
    const auto points_along = [](float length_m) {
      return std::max(2, static_cast<int>(std::ceil(length_m / kGridStep_m)) + 1);
    };
    Grid grid{.num_columns = points_along(r.size_m.x()),
              .num_rows = points_along(r.size_m.y()),
              .first = num_values,
              .size_m = r.size_m};
    num_values +=
        static_cast<std::size_t>(grid.num_columns) * static_cast<std::size_t>(grid.num_rows);
    grids_.push_back(grid);
  }
  values_.assign(num_values, Colour::Zero());
}

Colour& SurfaceColours::value(int rectangle, int column, int row) {
  const Grid& g = grid(rectangle);
  return values_[g.first + static_cast<std::size_t>(row) * static_cast<std::size_t>(g.num_columns) +
                 static_cast<std::size_t>(column)];
}

Eigen::Vector2f SurfaceColours::position(int rectangle, int column, int row) const {
  const Grid& g = grid(rectangle);
  const Eigen::Vector2f& size_m = g.size_m;
  const Eigen::Vector2f ratio(static_cast<float>(column) / static_cast<float>(g.num_columns - 1),
                              static_cast<float>(row) / static_cast<float>(g.num_rows - 1));
  const Eigen::Vector2f margin_m = size_m.cwiseMin(0.05F) * 0.2F;
  return margin_m + ratio.cwiseProduct(size_m - 2.0F * margin_m);
}

Colour SurfaceColours::at(int rectangle, const Eigen::Vector2f& right_up_m) const {
  const Grid& g = grid(rectangle);
  const Eigen::Array2f ratio = right_up_m.array() / g.size_m.array();
  const float x = ratio.x() * static_cast<float>(g.num_columns - 1);
  const float y = ratio.y() * static_cast<float>(g.num_rows - 1);
  const int column = std::clamp(static_cast<int>(x), 0, g.num_columns - 2);
  const int row = std::clamp(static_cast<int>(y), 0, g.num_rows - 2);
  const float right = std::clamp(x - static_cast<float>(column), 0.0F, 1.0F);
  const float up = std::clamp(y - static_cast<float>(row), 0.0F, 1.0F);
  const Colour* const lower =
      &values_[g.first + static_cast<std::size_t>(row * g.num_columns + column)];
  const Colour* const upper = lower + g.num_columns;
  return (1.0F - up) * ((1.0F - right) * lower[0] + right * lower[1]) +
         up * ((1.0F - right) * upper[0] + right * upper[1]);
}

}  // namespace samewhere::twin
