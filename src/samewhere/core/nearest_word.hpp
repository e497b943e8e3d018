#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace samewhere::core {

// The least number of letters to insert, delete, replace or swap with their neighbour that turns
// one word into the other (optimal string alignment distance).
int edit_distance(std::string_view a, std::string_view b);

// Of the known words the one that was probably meant: nearest by edit distance, at most 2 away and
// less than half of its letters. Nothing if none is that near; the first of those equally near.
std::optional<std::string> nearest_word(std::string_view word, std::span<const std::string> known);

}  // namespace samewhere::core
