#pragma once

#include <span>
#include <vector>

namespace samewhere::geometry {

// Real roots of c[0] + c[1] x + ... + c[n] x^n, degree at most 4, ascending. Leading zeros lower
// the degree; the zero polynomial and constants have none. Double roots may come once, twice or (by
// rounding) not at all.
std::vector<double> real_roots(std::span<const double> coefficients);

}  // namespace samewhere::geometry
