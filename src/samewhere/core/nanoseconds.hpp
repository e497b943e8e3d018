#pragma once

#include <cstdint>

namespace samewhere::core {

// Stamps of recordings are whole nanoseconds in many formats (ROS, MCAP, EuRoC). As seconds they
// are the double nearest to them, which reading their decimal digits gives, too: a stamp with nine
// decimals or fewer comes back unchanged.
std::int64_t nanoseconds_of(double seconds);  // of what no 64 bits hold, the nearest that they do
double seconds_of(std::int64_t nanoseconds);

// The stamp in whole nanoseconds.
double in_whole_nanoseconds(double seconds);

}  // namespace samewhere::core
