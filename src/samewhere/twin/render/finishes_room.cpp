#include <array>
#include <cmath>

#include <samewhere/twin/render/finishes.hpp>

namespace samewhere::twin {
namespace {

// The point shifted by noise: what is round becomes a blot.
template <class Seed>
TexturePoint crumpled(const TexturePoint& p, const Seed& seed) {
  constexpr float kPer_m = 40.0F;
  constexpr float kShift_m = 0.011F;
  if (p.footprint_m * kPer_m > 1.0F) return p;
  const float shift_m = kShift_m * value_noise(p.u_m * kPer_m, p.v_m * kPer_m, seed);
  return {p.u_m + shift_m, p.v_m - shift_m, p.footprint_m};
}

// Blocks laid in half bond.
struct Bond {
  float length_m = 0.4F;
  float height_m = 0.2F;
  float half_joint_m = 0.005F;
  float tone = 0.045F;  // by how much blocks differ
  float joint = 0.42F;  // light that a joint swallows
};

float masonry(const TexturePoint& p, const Bond& bond, const Grain& grain) {
  const int row = floor_int(p.v_m / bond.height_m);
  const float u_m = p.u_m + 0.5F * bond.length_m * static_cast<float>(row & 1);
  const float to_joint_m =
      std::min(to_grid_line_m(u_m, bond.length_m), to_grid_line_m(p.v_m, bond.height_m));
  const float tone = bond.tone * grid_value(floor_int(u_m / bond.length_m), row, grain);
  return (1.0F + tone) *
         (1.0F - bond.joint * on_line(to_joint_m, bond.half_joint_m, p.footprint_m));
}

// Paint with a darker dado and the line above it, if it has two colours.
Colour dado_paint(const Material& m, const TexturePoint& p) {
  constexpr float kDado_m = 1.05F;
  constexpr float kLine_m = 0.02F;
  if ((m.colour == m.second).all()) return m.colour;
  const float dado = beyond(kDado_m - p.v_m, p.footprint_m);
  const float line = inside(p.v_m, kDado_m, kDado_m + kLine_m, p.footprint_m);
  return mixed(m.colour, m.second, dado) * (1.0F - 0.4F * line);
}

// Boards in a grid of bars.
struct CeilingTile {
  float wide_m, long_m, half_bar_m;
  float bar;  // colour of the bars over that of their paint
  float hole_cell_m;
  float holes, cracks;  // light that they swallow
};
constexpr std::array<CeilingTile, kNumCeilingTiles> kCeilingTiles = {
    {{0.6F, 0.6F, 0.012F, 1.0F, 0.045F, 0.6F, 0.65F},
     {0.3F, 1.5F, 0.004F, 0.6F, 0.02F, 0.4F, 0.0F},
     {0.6F, 1.2F, 0.012F, 1.0F, 0.045F, 0.0F, 0.25F},
     {1.8F, 0.1F, 0.009F, 0.25F, 0.045F, 0.05F, 0.0F},
     {0.5F, 0.5F, 0.006F, 0.5F, 0.03F, 0.65F, 0.0F}}};

// Share of light that traffic leaves of a wall: scuffs of shoes and trolleys near the floor, hands
// a metre up, more of both in some places than in others.
float trodden(const TexturePoint& p, const Material& m) {
  constexpr float kShoes_m = 0.35F;
  constexpr float kHands_m = 1.1F;
  constexpr float kAroundHands_m = 0.3F;
  const float low = clamp01(1.0F - p.v_m / kShoes_m);
  const float hands = clamp01(1.0F - std::abs(p.v_m - kHands_m) / kAroundHands_m);
  if (low + hands <= 0.0F) return 1.0F;
  const Grain grain = grain_of(m) + 70;
  const float often = clamp01(0.3F + value_noise(p.u_m * 0.9F, 0.0F, grain));
  const TexturePoint crumpled_p = crumpled(p, grain);
  const float scuffs = 0.9F * scratches(crumpled_p, {.cell_m = 0.17F, .density = 0.5F}, grain + 1) +
                       0.2F * spots(crumpled_p, {.cell_m = 0.13F, .density = 0.3F}, grain + 2);
  const float prints = 0.12F * spots(crumpled_p, {.cell_m = 0.08F, .density = 0.3F}, grain + 3);
  return 1.0F - often * (low * (0.06F + 0.4F * scuffs) + hands * prints);
}

// Clouds of dirt a metre across.
float clouds(const TexturePoint& p, std::uint32_t wear_seed, float strength) {
  return strength *
         octave_noise(p, {.wavelength_m = 1.4F, .count = 2, .gain = 0.5F}, wear_seed + 60);
}

}  // namespace

float marked(const TexturePoint& p, const Material& m, float strength) {
  const Grain grain = grain_of(m) + 40;
  float marks = 0.35F * scratches(p, {.cell_m = 0.29F, .density = 0.15F}, grain + 4) +
                0.9F * spots(p, {.cell_m = 0.03F, .density = 0.03F}, grain + 5);  // chips
  const std::uint32_t wear = m.wear_seed;
  constexpr float kFine_m = 0.0032F;
  const float fine = visible_share(kFine_m, p.footprint_m);
  if (fine > 0.0F) {
    // in patches: where hands and bags go
    const float worn_off = 0.75F + 0.8F * value_noise(p.u_m * 4.0F, p.v_m * 4.0F, wear + 4);
    marks += fine * std::max(worn_off, 0.3F) *
             (0.8F * spots(p, {.cell_m = 0.009F, .density = 0.3F}, wear + 1) +
              1.1F * scratches(p, {.cell_m = 0.05F, .density = 0.35F}, wear + 2));
    marks -= 0.16F * octave_noise(p, {.wavelength_m = 0.003F, .count = 2, .gain = 0.8F}, wear + 3);
  }
  return 1.0F - std::min(strength * marks, 0.8F);
}

float blotted(const Rectangle& rectangle, const TexturePoint& point) {
  const std::uint32_t seed = rectangle.material.blot_seed;
  if (seed == 0) return 1.0F;
  const Eigen::Vector2f ratio(2.0F * point.u_m / rectangle.size_m.x() - 1.0F,
                              2.0F * point.v_m / rectangle.size_m.y() - 1.0F);
  const TexturePoint p{ratio.x(), ratio.y(),
                       2.0F * point.footprint_m / rectangle.size_m.minCoeff()};
  const float ragged =
      0.3F * octave_noise(p, {.wavelength_m = 0.8F, .count = 5, .gain = 0.6F}, seed);
  // a dried puddle: darkest along its rim
  const float from_rim = 0.6F + ragged - ratio.norm();
  const float puddle = clamp01(from_rim * 25.0F);
  const float rim = puddle * clamp01(1.0F - 5.0F * from_rim);
  const float strokes = scratches(p, {.cell_m = 0.9F, .density = 0.8F}, seed + 7) +
                        scratches(p, {.cell_m = 0.5F, .density = 0.3F}, seed + 8);
  const float fade = clamp01(4.0F * (1.0F - ratio.norm()));
  const bool is_scratched = (seed & 2U) != 0;
  const float loss = is_scratched ? 0.5F * strokes : 0.08F * puddle + 0.12F * rim;
  return 1.0F - std::min(fade * loss, 0.6F);
}

Colour block_wall(const Material& m, const TexturePoint& p) {
  const Grain grain = grain_of(m);
  const float rough =
      0.03F * octave_slope(p, {.wavelength_m = 0.06F, .count = 4, .gain = 1.7F}, grain + 20);
  const float wear = lerp(0.75F, 0.45F, clamp01(p.v_m / 2.0F));
  return dado_paint(m, p) * ((1.0F + clouds(p, m.wear_seed, 0.03F) + rough) * trodden(p, m) *
                             masonry(p, {}, grain + 30) * marked(p, m, wear));
}

Colour brick_wall(const Material& m, const TexturePoint& p) {
  constexpr Bond kBricks{0.25F, 0.0755F, 0.005F, 0.1F, 0.35F};
  const Grain grain = grain_of(m);
  const float rough =
      0.03F * octave_slope(p, {.wavelength_m = 0.05F, .count = 4, .gain = 1.6F}, grain + 20);
  return dado_paint(m, p) * ((1.0F + clouds(p, m.wear_seed, 0.03F) + rough) *
                             masonry(p, kBricks, grain + 30) * marked(p, m, 0.4F));
}

Colour ceiling_plaster(const Material& m, const TexturePoint& p) {
  const Grain grain = grain_of(m);
  const float rough =
      0.05F * octave_slope(p, {.wavelength_m = 0.03F, .count = 3, .gain = 1.4F}, grain + 20);
  const float patches =
      0.012F * octave_noise(p, {.wavelength_m = 0.5F, .count = 4, .gain = 0.7F}, grain + 30);
  return m.colour *
         ((1.0F + rough + patches + clouds(p, m.wear_seed, 0.02F)) * marked(p, m, 0.42F));
}

Colour plaster(const Material& m, const TexturePoint& p) {
  return ceiling_plaster(m, p) * trodden(p, m);
}

Colour concrete(const Material& m, const TexturePoint& p) {
  constexpr float kBoard_m = 1.25F;
  const Grain grain = grain_of(m);
  const float cast =
      0.07F * octave_noise(p, {.wavelength_m = 0.45F, .count = 6, .gain = 0.75F}, grain);
  const float pores = 0.6F * spots(p, {.cell_m = 0.026F, .density = 0.2F}, grain + 8);
  const float to_joint_m =
      std::min(to_grid_line_m(p.u_m, 2.0F * kBoard_m), to_grid_line_m(p.v_m, kBoard_m));
  const float joint = on_line(to_joint_m, 0.004F, p.footprint_m);
  return m.colour *
         ((1.0F + cast + clouds(p, m.wear_seed, 0.06F)) * (1.0F - 0.6F * std::min(pores, 1.0F)) *
          (1.0F - 0.3F * joint) * marked(p, m, 0.4F));
}

Colour carpet(const Material& m, const TexturePoint& in_unit) {
  constexpr float kTile_m = 0.5F;
  const Grain grain = grain_of(m);
  const int tile_u = floor_int(in_unit.u_m / kTile_m);
  const int tile_v = floor_int(in_unit.v_m / kTile_m);
  TexturePoint p = in_unit;
  if (((tile_u + tile_v) & 1) != 0) std::swap(p.u_m, p.v_m);  // laid in turns
  const float to_seam_m =
      std::min(to_grid_line_m(in_unit.u_m, kTile_m), to_grid_line_m(in_unit.v_m, kTile_m));
  const float seam = on_line(to_seam_m, 0.003F, in_unit.footprint_m);
  const float bars = 0.36F * mosaic(p, 0.31F, 0.045F, grain) +
                     0.28F * mosaic(p, 0.11F, 0.085F, grain + 1) +
                     0.26F * mosaic(p, 0.037F, 0.037F, grain + 2);
  const float pile =
      0.18F * octave_noise(p, {.wavelength_m = 0.016F, .count = 2, .gain = 0.8F}, grain + 3);
  // trodden down, with fluff on it
  const float trodden = clouds(in_unit, m.wear_seed, 0.09F);
  float fluff = 0.5F * spots(in_unit, {.cell_m = 0.31F, .density = 0.06F}, m.wear_seed + 1);
  if (p.footprint_m < 0.004F) {
    fluff +=
        0.8F * scratches(in_unit, {.cell_m = 0.04F, .density = 0.25F}, m.wear_seed + 2) +
        0.3F * octave_noise(p, {.wavelength_m = 0.004F, .count = 2, .gain = 0.8F}, m.wear_seed + 3);
  }
  const float fleck = spots(p, {.cell_m = 0.07F, .density = 0.35F}, grain + 20);
  const Colour yarn = mixed(m.colour, m.second, 0.5F * fleck);
  constexpr float kDarkest = 0.08F;  // where all of it is dark at once
  const float shade = std::max(1.0F + bars + pile + trodden + 0.35F * fluff, kDarkest);
  return yarn * (shade * (1.0F - 0.3F * seam));
}

Colour floor_tiles(const Material& m, const TexturePoint& p) {
  constexpr float kTile_m = 0.3F;
  const Grain grain = grain_of(m);
  const int tile_u = floor_int(p.u_m / kTile_m);
  const int tile_v = floor_int(p.v_m / kTile_m);
  const float tone = 0.06F * grid_value(tile_u, tile_v, grain);
  const float to_joint_m = std::min(to_grid_line_m(p.u_m, kTile_m), to_grid_line_m(p.v_m, kTile_m));
  const float joint = on_line(to_joint_m, 0.0025F, p.footprint_m);
  const float speckle =
      0.10F * octave_noise(p, {.wavelength_m = 0.05F, .count = 4, .gain = 0.9F}, grain + 1) -
      0.4F * spots(p, {.cell_m = 0.028F, .density = 0.5F}, grain + 8) +
      0.25F * spots(p, {.cell_m = 0.045F, .density = 0.4F}, grain + 9);
  const Colour stone = m.colour * (1.0F + tone + speckle + clouds(p, m.wear_seed, 0.06F));
  return mixed(stone, m.second, joint) * marked(p, m, 0.35F);
}

Colour planks(const Material& m, const TexturePoint& p) {
  constexpr float kWide_m = 0.12F;
  constexpr float kLong_m = 1.2F;
  const Grain grain = grain_of(m);
  const int row = floor_int(p.v_m / kWide_m);
  const float u_m = p.u_m + 0.37F * kLong_m * static_cast<float>(row % 5);
  const int plank = floor_int(u_m / kLong_m);
  const float tone = 0.14F * grid_value(plank, row, grain);
  const float to_joint_m = std::min(to_grid_line_m(u_m, kLong_m), to_grid_line_m(p.v_m, kWide_m));
  const float joint = on_line(to_joint_m, 0.0012F, p.footprint_m);
  const TexturePoint stretched{p.u_m * 0.06F + 0.31F * static_cast<float>(plank), p.v_m,
                               p.footprint_m};
  const float fibres =
      0.16F *
      octave_noise(stretched, {.wavelength_m = 0.05F, .count = 4, .gain = 0.75F}, grain + 1);
  const float knots = spots(p, {.cell_m = 0.29F, .density = 0.25F}, grain + 8);
  const Colour board = m.colour * (1.0F + tone + fibres - 0.35F * knots);
  return mixed(board, m.second, 0.8F * joint) *
         ((1.0F + clouds(p, m.wear_seed, 0.05F)) * marked(p, m, 0.35F));
}

// Which one: `number`.
Colour ceiling_tiles(const Material& m, const TexturePoint& in_unit) {
  const CeilingTile& kind =
      kCeilingTiles[static_cast<std::size_t>(m.number) % kCeilingTiles.size()];
  const Grain grain = grain_of(m);
  // where the grid begins
  const TexturePoint p{in_unit.u_m + kind.wide_m * unit_float(scramble(m.pattern_seed)),
                       in_unit.v_m + kind.long_m * unit_float(scramble(m.pattern_seed + 1)),
                       in_unit.footprint_m};
  const int tile_u = floor_int(p.u_m / kind.wide_m);
  const int tile_v = floor_int(p.v_m / kind.long_m);
  const float tile = 0.03F * grid_value(tile_u, tile_v, grain);
  const float to_bar_m =
      std::min(to_grid_line_m(p.u_m, kind.wide_m), to_grid_line_m(p.v_m, kind.long_m));
  const float bar = on_line(to_bar_m, kind.half_bar_m, p.footprint_m);
  const float shadow_line = on_line(std::abs(to_bar_m - kind.half_bar_m), 0.004F, p.footprint_m);
  const float holes =
      kind.holes * spots(p, {.cell_m = kind.hole_cell_m, .density = 0.7F}, grain + 1) +
      kind.cracks * scratches(p, {.cell_m = 0.09F, .density = 0.7F}, grain + 2);
  const float fibres =
      0.04F * octave_noise(p, {.wavelength_m = 0.03F, .count = 3, .gain = 0.7F}, grain + 4);
  const Colour board = m.colour * ((1.0F + tile + fibres + clouds(p, m.wear_seed, 0.03F)) *
                                   (1.0F - std::min(holes, 0.7F)));
  return mixed(board, kind.bar * m.second, bar) * (1.0F - 0.35F * shadow_line);
}

}  // namespace samewhere::twin
