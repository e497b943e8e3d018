#pragma once

#include <string>
#include <vector>

#include <samewhere/report/record.hpp>

namespace samewhere::report {

// PLY, binary little endian: per vertex float x y z (metres), uchar red green blue. Points that are
// not finite are left out.
std::string ply_bytes(const std::vector<ColouredPoint>& points);

}  // namespace samewhere::report
