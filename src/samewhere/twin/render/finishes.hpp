#pragma once

#include <algorithm>

#include <samewhere/twin/building/noise.hpp>
#include <samewhere/twin/building/surface.hpp>

namespace samewhere::twin {

// The finishes one by one; texture.hpp chooses among them. Points are measured in the pattern's
// coordinates unless a rectangle is asked for: then from its corner.

inline Grain grain_of(const Material& m) {
  return {m.pattern_seed, m.own_pattern_seed, m.own_ratio};
}

inline Colour mixed(const Colour& under, const Colour& over, float coverage) {
  return under + coverage * (over - under);
}

// Distance to the nearest edge of a grid of squares.
inline float to_grid_line_m(float x, float cell_m) {
  const float cells = x / cell_m;
  const float in_cell = cells - static_cast<float>(floor_int(cells));
  return cell_m * std::min(in_cell, 1.0F - in_cell);
}

// Share of light that marks leave: those that came with the surface (common) and wear, which is
// fine enough to be lost from a few metres away.
float marked(const TexturePoint& p, const Material& m, float strength);
// Share of light that a big stain or scratch in the middle of the rectangle leaves.
float blotted(const Rectangle& rectangle, const TexturePoint& point);

// Rooms.
Colour block_wall(const Material& m, const TexturePoint& p);
Colour brick_wall(const Material& m, const TexturePoint& p);
Colour plaster(const Material& m, const TexturePoint& p);
Colour ceiling_plaster(const Material& m, const TexturePoint& p);
Colour concrete(const Material& m, const TexturePoint& p);
Colour carpet(const Material& m, const TexturePoint& p);
Colour floor_tiles(const Material& m, const TexturePoint& p);
Colour planks(const Material& m, const TexturePoint& p);
Colour ceiling_tiles(const Material& m, const TexturePoint& p);

// Things.
Colour wood(const Material& m, const TexturePoint& p);
Colour paint(const Material& m, const TexturePoint& p);
Colour plastic(const Material& m, const TexturePoint& p);
Colour steel(const Material& m, const TexturePoint& p);
Colour cork(const Material& m, const TexturePoint& p);
Colour fabric(const Material& m, const TexturePoint& p);
Colour soil(const Material& m, const TexturePoint& p);
Colour skin(const Material& m, const TexturePoint& p);
Colour hair(const Material& m, const TexturePoint& p);
Colour grille(const Material& m, const TexturePoint& p);
Colour leaf(const Rectangle& r, const TexturePoint& p);
Colour carton(const Rectangle& r, const TexturePoint& p);
Colour books(const Rectangle& r, const TexturePoint& p);

// What shines.
Colour lamp(const Rectangle& r, const TexturePoint& p);
Colour blinds(const Rectangle& r, const TexturePoint& p);
Colour window_view(const Rectangle& r, const TexturePoint& p);

}  // namespace samewhere::twin
