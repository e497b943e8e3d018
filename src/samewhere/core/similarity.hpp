#pragma once

#include <span>
#include <vector>

namespace samewhere::core {

// Sum of x_i y_i. Spans of one length; anything else throws ContractError. The order of the
// additions is fixed, so the same vectors give the same bits.
float dot(std::span<const float> x, std::span<const float> y);

// Cosine of the angle between two vectors, eq. (7) of the published method (docs/paper-map.md): in
// [-1, 1]; 0 if either has no length.
double cosine(std::span<const float> x, std::span<const float> y);

// Normalised cross-correlation of two vectors, eq. (8)-(13): in [-1, 1], blind to the brightness
// (an offset) and the contrast (a positive factor) of either; 0 if either is constant, because a
// black image correlates with nothing.
double ncc(std::span<const float> x, std::span<const float> y);

// The vector with its mean removed and its length made 1, or all zero if it is constant:
// ncc(x, y) = dot(centred_unit(x), centred_unit(y)) up to rounding.
std::vector<float> centred_unit(std::span<const float> x);

// 1 / |x - mean(x)|, or 0 if x is constant. With it an NCC costs one dot product and y keeps its
// mean: ncc(x, y) = dot(centred_unit(x), y) * inverse_deviation(y) up to rounding.
float inverse_deviation(std::span<const float> x);

// The vector with its length made 1, or all zero if it has none.
std::vector<float> unit(std::span<const float> x);

// Whether the vector has length 1, up to the rounding of floats, or none at all; false where an
// element is not a number.
bool is_unit_or_zero(std::span<const float> x);

}  // namespace samewhere::core
