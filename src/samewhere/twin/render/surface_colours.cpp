#include <algorithm>
#include <cmath>

#include <samewhere/twin/render/surface_colours.hpp>

namespace samewhere::twin {
namespace {

SurfaceColours::Axis axis_of(float length_m) {
  constexpr float kGridStep_m = 0.1F;
  constexpr float kThin_m = 0.08F;
  constexpr int kCoarseStep = 4;
  const int num_steps = std::max(1, static_cast<int>(std::ceil(length_m / kGridStep_m)));
  if (num_steps < 2 * kCoarseStep) {
    return {.num_points = num_steps + 1, .is_thin = length_m < kThin_m};
  }
  const int num_coarse_steps = (num_steps + kCoarseStep - 1) / kCoarseStep;
  return {.num_points = num_coarse_steps * kCoarseStep + 1, .coarse_step = kCoarseStep};
}

float position_m(const SurfaceColours::Axis& axis, int index, float length_m) {
  if (axis.is_thin) return 0.5F * length_m;
  const float margin_m = 0.2F * std::min(length_m, 0.05F);
  const float ratio = static_cast<float>(index) / static_cast<float>(axis.num_points - 1);
  return margin_m + ratio * (length_m - 2.0F * margin_m);
}

}  // namespace

SurfaceColours::SurfaceColours(const std::vector<Rectangle>& rectangles) {
  std::size_t num_values = 0;
  for (const auto& r : rectangles) {
    const Grid grid{.columns = axis_of(r.size_m.x()),
                    .rows = axis_of(r.size_m.y()),
                    .first = num_values,
                    .size_m = r.size_m};
    num_values += static_cast<std::size_t>(grid.columns.num_points) *
                  static_cast<std::size_t>(grid.rows.num_points);
    grids_.push_back(grid);
  }
  values_.assign(num_values, Colour::Zero());
}

Colour& SurfaceColours::value(int rectangle, int column, int row) {
  const Grid& g = grid(rectangle);
  return values_[g.first + static_cast<std::size_t>(row * g.columns.num_points + column)];
}

Eigen::Vector2f SurfaceColours::position(int rectangle, int column, int row) const {
  const Grid& g = grid(rectangle);
  return {position_m(g.columns, column, g.size_m.x()), position_m(g.rows, row, g.size_m.y())};
}

Colour SurfaceColours::at(int rectangle, const Eigen::Vector2f& right_up_m) const {
  const Grid& g = grid(rectangle);
  const Eigen::Array2f ratio = right_up_m.array() / g.size_m.array();
  const int num_columns = g.columns.num_points;
  const int num_rows = g.rows.num_points;
  const float x = ratio.x() * static_cast<float>(num_columns - 1);
  const float y = ratio.y() * static_cast<float>(num_rows - 1);
  const int column = std::clamp(static_cast<int>(x), 0, num_columns - 2);
  const int row = std::clamp(static_cast<int>(y), 0, num_rows - 2);
  const float right = std::clamp(x - static_cast<float>(column), 0.0F, 1.0F);
  const float up = std::clamp(y - static_cast<float>(row), 0.0F, 1.0F);
  const Colour* const lower =
      &values_[g.first + static_cast<std::size_t>(row * num_columns + column)];
  const Colour* const upper = lower + num_columns;
  return (1.0F - up) * ((1.0F - right) * lower[0] + right * lower[1]) +
         up * ((1.0F - right) * upper[0] + right * upper[1]);
}

}  // namespace samewhere::twin
