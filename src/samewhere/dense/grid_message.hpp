#pragma once

#include <samewhere/core/rigid3.hpp>
#include <samewhere/dense/occupancy_grid.hpp>
#include <samewhere/messages/messages.hpp>

namespace samewhere::dense {

// A grid as nav_msgs/OccupancyGrid; header and map_load_time are not set. `frame_from_world`: from
// the world of the scans to the frame of the message, in which the origin tells how the floor lies.
messages::OccupancyGrid grid_message(const OccupancyGrid& grid,
                                     const core::Rigid3& frame_from_world);

}  // namespace samewhere::dense
