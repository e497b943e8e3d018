#include <samewhere/dense/grid_message.hpp>

namespace samewhere::dense {

messages::OccupancyGrid grid_message(const OccupancyGrid& grid,
                                     const core::Rigid3& frame_from_world) {
  constexpr std::int8_t kValues[] = {-1, 0, 100};  // by Cell
  const core::Rigid3 frame_from_map = frame_from_world * core::inverse(grid.map_from_world);
  const Eigen::Vector3d corner =
      frame_from_map * Eigen::Vector3d(grid.corner_in_map.x(), grid.corner_in_map.y(), 0.0);
  const Eigen::Quaterniond& q = frame_from_map.rotation;
  messages::OccupancyGrid message;
  message.info = {.resolution = static_cast<float>(grid.cell_m),
                  .width = static_cast<std::uint32_t>(grid.log_odds.cols),
                  .height = static_cast<std::uint32_t>(grid.log_odds.rows),
                  .origin = {.position = {corner.x(), corner.y(), corner.z()},
                             .orientation = {q.x(), q.y(), q.z(), q.w()}}};
  message.data.reserve(static_cast<std::size_t>(grid.log_odds.total()));
  for (int row = 0; row < grid.log_odds.rows; ++row) {
    for (int column = 0; column < grid.log_odds.cols; ++column)
      message.data.push_back(kValues[static_cast<int>(grid.at(row, column))]);
  }
  return message;
}

}  // namespace samewhere::dense
