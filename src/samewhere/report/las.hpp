#pragma once

#include <string>
#include <vector>

#include <samewhere/report/record.hpp>

namespace samewhere::report {

// LAS 1.2 with points of format 2: x y z as whole multiples of 0.1 mm (more where that would not
// fit into 32 bits) from an offset, and colour, of which 255 becomes 65535. No coordinate system is
// named and the date is 0. Points that are not finite are left out. Source: LAS Specification 1.2,
// ASPRS 2008.
std::string las_bytes(const std::vector<ColouredPoint>& points);

}  // namespace samewhere::report
