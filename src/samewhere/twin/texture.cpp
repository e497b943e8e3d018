#include <samewhere/twin/print.hpp>
#include <samewhere/twin/texture.hpp>

namespace samewhere::twin {
namespace {

// Distance to the nearest edge of a grid of squares.
float to_grid_line_m(float x, float cell_m) {
  const float cells = x / cell_m;
  const float in_cell = cells - static_cast<float>(floor_int(cells));
  return cell_m * std::min(in_cell, 1.0F - in_cell);
}

// The point shifted by noise: what is round becomes a blot.
TexturePoint crumpled(const TexturePoint& p, std::uint32_t seed) {
  constexpr float kPer_m = 40.0F;
  constexpr float kShift_m = 0.011F;
  if (p.footprint_m * kPer_m > 1.0F) return p;
  const float u = p.u_m * kPer_m;
  const float v = p.v_m * kPer_m;
  return {p.u_m + kShift_m * value_noise(u, v, seed),
          p.v_m + kShift_m * value_noise(u, v, seed + 1), p.footprint_m};
}

// Share of light that dirt, chips and scratches leave.
float worn(const TexturePoint& p, std::uint32_t seed, float strength) {
  const TexturePoint crumpled_p = crumpled(p, seed);
  const float dirt = 0.9F * spots(crumpled_p, {.cell_m = 0.07F, .density = 0.16F}, seed + 2) +
                     0.5F * spots(crumpled_p, {.cell_m = 0.23F, .density = 0.25F}, seed + 3) +
                     0.9F * scratches(p, {.cell_m = 0.29F, .density = 0.35F}, seed + 4);
  return 1.0F - std::min(strength * dirt, 0.8F);
}

// Light and shade of a rough surface lit from above: the slope of its height.
float relief(const TexturePoint& p, const Octaves& octaves, std::uint32_t seed) {
  constexpr float kStep_m = 0.008F;
  const TexturePoint above{p.u_m, p.v_m + kStep_m, p.footprint_m};
  return octave_noise(above, octaves, seed) - octave_noise(p, octaves, seed);
}

// Joints and tone of a wall of blocks laid in half bond.
float masonry(const TexturePoint& p, std::uint32_t seed) {
  constexpr float kLength_m = 0.4F;
  constexpr float kHeight_m = 0.2F;
  constexpr float kHalfJoint_m = 0.005F;
  const int row = floor_int(p.v_m / kHeight_m);
  const float u_m = p.u_m + 0.5F * kLength_m * static_cast<float>(row & 1);
  const float to_joint_m =
      std::min(to_grid_line_m(u_m, kLength_m), to_grid_line_m(p.v_m, kHeight_m));
  const float tone = 0.045F * grid_value(floor_int(u_m / kLength_m), row, seed);
  return (1.0F + tone) * (1.0F - 0.42F * on_line(to_joint_m, kHalfJoint_m, p.footprint_m));
}

Colour wall(const Material& m, const TexturePoint& p) {
  constexpr float kDado_m = 1.05F;
  constexpr float kLine_m = 0.02F;
  const float dado = beyond(kDado_m - p.v_m, p.footprint_m);
  const float line = inside(p.v_m, kDado_m, kDado_m + kLine_m, p.footprint_m);
  const float stains =
      0.06F * octave_noise(p, {.wavelength_m = 1.7F, .count = 5, .gain = 0.65F}, m.wear_seed);
  const float rough =
      0.21F * relief(p, {.wavelength_m = 0.06F, .count = 4, .gain = 0.85F}, m.wear_seed + 20);
  const float wear = lerp(0.75F, 0.45F, clamp01(p.v_m / 2.0F));
  const Colour paint = m.colour + dado * (m.second - m.colour);
  return paint * ((1.0F + stains + rough) * (1.0F - 0.4F * line) * masonry(p, m.wear_seed + 30) *
                  worn(p, m.wear_seed + 40, wear));
}

Colour carpet(const Material& m, const TexturePoint& world) {
  constexpr float kTile_m = 0.5F;
  const int tile_u = floor_int(world.u_m / kTile_m);
  const int tile_v = floor_int(world.v_m / kTile_m);
  TexturePoint p = world;
  if (((tile_u + tile_v) & 1) != 0) std::swap(p.u_m, p.v_m);  // laid in turns
  const float to_seam_m =
      std::min(to_grid_line_m(world.u_m, kTile_m), to_grid_line_m(world.v_m, kTile_m));
  const float seam = on_line(to_seam_m, 0.003F, world.footprint_m);
  const float bars = 0.36F * mosaic(p, 0.31F, 0.045F, m.wear_seed) +
                     0.28F * mosaic(p, 0.11F, 0.085F, m.wear_seed + 1) +
                     0.26F * mosaic(p, 0.037F, 0.037F, m.wear_seed + 2);
  const float pile =
      0.18F * octave_noise(p, {.wavelength_m = 0.016F, .count = 3, .gain = 0.8F}, m.wear_seed + 3);
  const float stains = 0.10F * octave_noise(world, {.wavelength_m = 1.9F, .count = 4, .gain = 0.6F},
                                            m.wear_seed + 10);
  const float fleck = spots(p, {.cell_m = 0.07F, .density = 0.35F}, m.wear_seed + 20);
  const Colour yarn = m.colour + (0.5F * fleck) * (m.second - m.colour);
  return yarn * ((1.0F + bars + pile + stains) * (1.0F - 0.3F * seam));
}

Colour ceiling(const Material& m, const TexturePoint& p) {
  constexpr float kTile_m = 0.6F;
  constexpr float kHalfBar_m = 0.012F;
  const int tile_u = floor_int(p.u_m / kTile_m);
  const int tile_v = floor_int(p.v_m / kTile_m);
  const float tile = unit_float(hash_cell(tile_u, tile_v, m.wear_seed)) - 0.5F;
  const float to_bar_m = std::min(to_grid_line_m(p.u_m, kTile_m), to_grid_line_m(p.v_m, kTile_m));
  const float bar = on_line(to_bar_m, kHalfBar_m, p.footprint_m);
  const float shadow_line = on_line(std::abs(to_bar_m - kHalfBar_m), 0.004F, p.footprint_m);
  const float holes = 0.6F * spots(p, {.cell_m = 0.045F, .density = 0.7F}, m.wear_seed + 1) +
                      0.65F * scratches(p, {.cell_m = 0.09F, .density = 0.7F}, m.wear_seed + 2) +
                      0.12F * spots(p, {.cell_m = 0.43F, .density = 0.25F}, m.wear_seed + 3);
  const float grain =
      0.04F * octave_noise(p, {.wavelength_m = 0.03F, .count = 3, .gain = 0.7F}, m.wear_seed + 4);
  const Colour board = m.colour * ((1.0F + 0.06F * tile + grain) * (1.0F - std::min(holes, 0.7F)));
  return (board + bar * (m.second - board)) * (1.0F - 0.35F * shadow_line);
}

float wood_grain(const TexturePoint& p, std::uint32_t seed) {
  const float bend_m = 0.02F * value_noise(p.u_m * 4.0F, p.v_m * 1.3F, seed);
  const TexturePoint stretched{p.u_m + bend_m, p.v_m * 0.07F, p.footprint_m};
  const float fibres =
      octave_noise(stretched, {.wavelength_m = 0.11F, .count = 5, .gain = 0.75F}, seed + 1);
  const float knots = spots(p, {.cell_m = 0.34F, .density = 0.3F}, seed + 8);
  return 0.2F * fibres - 0.3F * knots;
}

Colour wood(const Material& m, const TexturePoint& p) {
  float grain = 0.0F;
  if (m.own_ratio < 1.0F) grain += (1.0F - m.own_ratio) * wood_grain(p, m.pattern_seed);
  if (m.own_ratio > 0.0F) grain += m.own_ratio * wood_grain(p, m.own_pattern_seed);
  return m.colour * ((1.0F + grain) * worn(p, m.wear_seed, 0.35F));
}

Colour paint(const Material& m, const TexturePoint& p) {
  const float grain =
      0.05F * octave_noise(p, {.wavelength_m = 0.12F, .count = 5, .gain = 0.7F}, m.wear_seed);
  return m.colour * ((1.0F + grain) * worn(p, m.wear_seed + 9, 0.4F));
}

Colour steel(const Material& m, const TexturePoint& p) {
  const TexturePoint stretched{p.u_m * 0.05F, p.v_m, p.footprint_m};
  const float brushed =
      0.12F *
      octave_noise(stretched, {.wavelength_m = 0.02F, .count = 4, .gain = 0.8F}, m.wear_seed);
  return m.colour * ((1.0F + brushed) * worn(p, m.wear_seed + 9, 0.35F));
}

Colour cork(const Material& m, const TexturePoint& p) {
  const float grain =
      0.16F * octave_noise(p, {.wavelength_m = 0.05F, .count = 4, .gain = 0.8F}, m.wear_seed) -
      0.35F * spots(p, {.cell_m = 0.03F, .density = 0.6F}, m.wear_seed + 9);
  return m.colour * (1.0F + grain);
}

Colour lamp(const Rectangle& r, const TexturePoint& p) {
  constexpr float kFrame_m = 0.025F;
  constexpr float kRib_m = 0.1F;
  const float u = std::min(p.u_m, r.size_m.x() - p.u_m);
  const float v = std::min(p.v_m, r.size_m.y() - p.v_m);
  const float frame = 1.0F - beyond(std::min(u, v) - kFrame_m, p.footprint_m);
  const float along_m = r.size_m.x() > r.size_m.y() ? u : v;
  const float rib = on_line(to_grid_line_m(along_m, kRib_m), 0.004F, p.footprint_m);
  return r.material.colour * ((1.0F - 0.75F * frame) * (1.0F - 0.35F * rib));
}

Colour blinds(const Rectangle& r, const TexturePoint& p) {
  constexpr float kSlat_m = 0.05F;
  const float slats = p.v_m / kSlat_m;
  const float phase = slats - static_cast<float>(floor_int(slats));
  const float share = visible_share(kSlat_m, p.footprint_m);
  const float bent = unit_float(hash_cell(floor_int(slats), 0, r.material.wear_seed));
  const float slat = 1.0F - share * (0.45F * phase + 0.2F * bent);
  const float cord = on_line(to_grid_line_m(p.u_m + 0.2F, 0.55F), 0.004F, p.footprint_m);
  const float outside = 0.25F * octave_noise(p, {.wavelength_m = 0.6F, .count = 3, .gain = 0.6F},
                                             r.material.wear_seed);
  const float sky = lerp(0.6F, 1.0F, clamp01(p.v_m / r.size_m.y()));
  return r.material.colour * (slat * sky * (1.0F + outside) * (1.0F - 0.5F * cord));
}

Colour grille(const Material& m, const TexturePoint& p) {
  constexpr float kPitch_m = 0.04F;
  const float to_slot_m = to_grid_line_m(p.u_m, kPitch_m);
  const float share = visible_share(kPitch_m, p.footprint_m);
  const float slot = lerp(0.45F, on_line(to_slot_m, 0.009F, p.footprint_m), share);
  return m.colour * ((1.0F - 0.75F * slot) * worn(p, m.wear_seed, 0.3F));
}

}  // namespace

Colour reflectance(const Rectangle& rectangle, const TexturePoint& point) {
  const Material& m = rectangle.material;
  const TexturePoint in_pattern{point.u_m + rectangle.pattern_m.x(),
                                point.v_m + rectangle.pattern_m.y(), point.footprint_m};
  switch (m.finish) {
    case Finish::kWall:
      return wall(m, in_pattern);
    case Finish::kCarpet:
      return carpet(m, in_pattern);
    case Finish::kCeiling:
      return ceiling(m, in_pattern);
    case Finish::kWood:
      return wood(m, point);
    case Finish::kPaint:
      return paint(m, point);
    case Finish::kSteel:
      return steel(m, point);
    case Finish::kCork:
      return cork(m, point);
    case Finish::kPlate:
      return door_plate(rectangle, point);
    case Finish::kPaper:
      return poster(rectangle, point);
    case Finish::kSign:
      return pictogram(rectangle, point);
    case Finish::kLamp:
      return lamp(rectangle, point);
    case Finish::kBlinds:
      return blinds(rectangle, point);
    case Finish::kGrille:
      return grille(m, point);
    default:
      return paint(m, point);
  }
  return m.colour;
}

Colour mean_reflectance(const Material& material) {
  if (material.finish == Finish::kWall) return 0.6F * material.colour + 0.4F * material.second;
  return 0.9F * material.colour;
}

bool is_emitting(const Material& material) { return material.radiance > 0.0F; }

}  // namespace samewhere::twin
