#pragma once

#include <samewhere/twin/building/piece.hpp>

namespace samewhere::twin {

// Small bright things side by side on a board: packets, piles of books, bottles and cups, each as
// far back and as high as it comes out. `room`: from the board's top to the highest that fits, in
// the coordinates of the piece. Draws until the piece begins its next part.
void add_clutter(Piece& piece, const Box& room);

}  // namespace samewhere::twin
