#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace samewhere::core {

// The text as one field of a CSV file: in quotes where it holds a comma, a quote or a line break
// (RFC 4180).
std::string csv_field(std::string_view text);

// The records of a CSV file, each with the line break that ends it; one in quotes ends none.
std::vector<std::string_view> csv_records(std::string_view text);

}  // namespace samewhere::core
