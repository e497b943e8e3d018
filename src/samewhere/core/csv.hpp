#pragma once

#include <string>
#include <string_view>

namespace samewhere::core {

// The text as one field of a CSV file: in quotes where it holds a comma, a quote or a line break
// (RFC 4180).
std::string csv_field(std::string_view text);

}  // namespace samewhere::core
