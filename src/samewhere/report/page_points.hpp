#pragma once

#include <cstddef>
#include <vector>

#include <nlohmann/json.hpp>

#include <samewhere/report/record.hpp>

namespace samewhere::report {

// Landmarks for the report page: positions as 16 bits per coordinate within the box that holds 99 %
// of them per axis and a quarter more on each side, and colours. Landmarks outside of the box are
// left out; of more than max_points every n-th stays. num_in_map counts all.
nlohmann::ordered_json page_points(const std::vector<ColouredPoint>& points,
                                   std::size_t max_points);

}  // namespace samewhere::report
