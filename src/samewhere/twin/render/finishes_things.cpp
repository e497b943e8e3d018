#include <cmath>

#include <samewhere/twin/render/finishes.hpp>

namespace samewhere::twin {
namespace {

// Share of a pixel on bars of a pitch, half of it each.
float stripes(float x_m, float pitch_m, float footprint_m) {
  const float share = visible_share(pitch_m, footprint_m);
  if (share <= 0.0F) return 0.5F;
  const float from_bar_m = to_grid_line_m(x_m, pitch_m);
  return lerp(0.5F, clamp01((from_bar_m - 0.25F * pitch_m) / footprint_m + 0.5F), share);
}

}  // namespace

Colour wood(const Material& m, const TexturePoint& p) {
  const Grain grain = grain_of(m);
  const float bend_m = 0.02F * value_noise(p.u_m * 4.0F, p.v_m * 1.3F, grain);
  const TexturePoint stretched{p.u_m + bend_m, p.v_m * 0.07F, p.footprint_m};
  const float fibres =
      octave_noise(stretched, {.wavelength_m = 0.11F, .count = 5, .gain = 0.75F}, grain + 1);
  const TexturePoint longer{p.u_m + bend_m, 0.4F * p.v_m, p.footprint_m};
  const float knots = spots(longer, {.cell_m = 0.13F, .density = 0.25F}, grain + 8);
  return m.colour * ((1.0F + 0.17F * fibres - 0.22F * knots) * marked(p, m, 0.35F));
}

Colour paint(const Material& m, const TexturePoint& p) {
  const float brushed =
      0.05F * octave_noise(p, {.wavelength_m = 0.12F, .count = 5, .gain = 0.7F}, grain_of(m));
  return m.colour * ((1.0F + brushed) * marked(p, m, 0.4F));
}

Colour plastic(const Material& m, const TexturePoint& p) {
  const float soft =
      0.03F * octave_noise(p, {.wavelength_m = 0.2F, .count = 3, .gain = 0.6F}, grain_of(m));
  return m.colour * ((1.0F + soft) * marked(p, m, 0.22F));
}

Colour steel(const Material& m, const TexturePoint& p) {
  const Grain grain = grain_of(m);
  const TexturePoint stretched{p.u_m * 0.02F, p.v_m, p.footprint_m};
  const float brushed =
      0.07F * octave_noise(stretched, {.wavelength_m = 0.006F, .count = 3, .gain = 0.8F}, grain);
  constexpr float kScattered = 0.75F;  // the rest is mirrored
  return m.colour * (kScattered * (1.0F + brushed) * marked(p, m, 0.3F));
}

Colour cork(const Material& m, const TexturePoint& p) {
  const Grain grain = grain_of(m);
  const float crumbs =
      0.16F * octave_noise(p, {.wavelength_m = 0.05F, .count = 4, .gain = 0.8F}, grain) -
      0.35F * spots(p, {.cell_m = 0.03F, .density = 0.6F}, grain + 9);
  const float holes = 0.6F * spots(p, {.cell_m = 0.02F, .density = 0.12F}, m.wear_seed);
  return m.colour * (1.0F + crumbs - holes);
}

// Plain, striped or checked cloth in soft folds.
Colour fabric(const Material& m, const TexturePoint& p) {
  const Grain grain = grain_of(m);
  const float pitch_m = 0.018F + 0.04F * unit_float(scramble(m.pattern_seed));
  const bool has_bars = m.number > 0;
  const float across = has_bars ? stripes(p.u_m, pitch_m, p.footprint_m) : 0.0F;
  const float along = m.number > 1 ? stripes(p.v_m, pitch_m, p.footprint_m) : across;
  const Colour dyed = mixed(m.colour, m.second, 0.5F * (across + along));
  const float folds =
      0.16F * octave_noise(p, {.wavelength_m = 0.22F, .count = 4, .gain = 0.55F}, grain);
  constexpr float kThread_m = 0.0035F;
  const float weave =
      0.12F * mosaic(p, kThread_m, 2.0F * kThread_m, grain + 5) +
      0.10F * octave_noise(p, {.wavelength_m = 0.02F, .count = 3, .gain = 0.8F}, grain + 6);
  const float lint = 0.4F * spots(p, {.cell_m = 0.03F, .density = 0.12F}, m.wear_seed);
  return dyed * (1.0F + folds + weave + lint);
}

Colour soil(const Material& m, const TexturePoint& p) {
  const float crumbs =
      0.5F * octave_noise(p, {.wavelength_m = 0.03F, .count = 4, .gain = 0.8F}, grain_of(m));
  return m.colour * std::max(1.0F + crumbs, 0.2F);
}

Colour skin(const Material& m, const TexturePoint& p) {
  const float tone =
      0.08F * octave_noise(p, {.wavelength_m = 0.09F, .count = 4, .gain = 0.6F}, grain_of(m));
  return m.colour * (1.0F + tone);
}

Colour hair(const Material& m, const TexturePoint& p) {
  const TexturePoint stretched{p.u_m, 0.12F * p.v_m, p.footprint_m};
  const float strands =
      0.45F *
      octave_noise(stretched, {.wavelength_m = 0.03F, .count = 4, .gain = 0.8F}, grain_of(m));
  return m.colour * std::max(1.0F + strands, 0.2F);
}

Colour grille(const Material& m, const TexturePoint& p) {
  constexpr float kPitch_m = 0.04F;
  const float to_slot_m = to_grid_line_m(p.u_m, kPitch_m);
  const float share = visible_share(kPitch_m, p.footprint_m);
  const float slot = lerp(0.45F, on_line(to_slot_m, 0.009F, p.footprint_m), share);
  return m.colour * ((1.0F - 0.75F * slot) * marked(p, m, 0.3F));
}

Colour leaf(const Rectangle& r, const TexturePoint& p) {
  const Material& m = r.material;
  const Grain grain = grain_of(m);
  const float from_rib_m = std::abs(p.u_m - 0.5F * r.size_m.x());
  const float rib = on_line(from_rib_m, 0.0015F, p.footprint_m);
  // side veins run forward from the rib
  const float veins = 0.25F * (0.5F - stripes(p.v_m - 0.8F * from_rib_m, 0.012F, p.footprint_m));
  const float tone =
      0.22F * octave_noise(p, {.wavelength_m = 0.06F, .count = 4, .gain = 0.6F}, grain);
  const float tip = 0.25F * clamp01(p.v_m / r.size_m.y());
  const float spot = 0.4F * spots(p, {.cell_m = 0.05F, .density = 0.2F}, m.wear_seed);
  const Colour blade = m.colour * (0.85F + tone + veins + tip - spot);
  return mixed(blade, 1.6F * m.colour + 0.03F, 0.7F * rib);
}

Colour carton(const Rectangle& r, const TexturePoint& p) {
  const Material& m = r.material;
  const Grain grain = grain_of(m);
  const float flutes = 0.05F * (stripes(p.u_m, 0.008F, p.footprint_m) - 0.5F);
  const float board =
      0.06F * octave_noise(p, {.wavelength_m = 0.15F, .count = 5, .gain = 0.65F}, grain);
  const float tape =
      inside(p.u_m, 0.5F * r.size_m.x() - 0.024F, 0.5F * r.size_m.x() + 0.024F, p.footprint_m);
  const float edge_m =
      std::min(std::min(p.u_m, r.size_m.x() - p.u_m), std::min(p.v_m, r.size_m.y() - p.v_m));
  const float edge = 0.15F * on_line(edge_m, 0.004F, p.footprint_m);
  // a printed mark below the label's height
  const TexturePoint print{p.u_m - 0.6F * r.size_m.x(), p.v_m - 0.62F * r.size_m.y(),
                           p.footprint_m};
  const float mark = inside(print.u_m, 0.0F, 0.3F * r.size_m.x(), p.footprint_m) *
                     inside(print.v_m, 0.0F, 0.22F * r.size_m.y(), p.footprint_m) *
                     clamp01(0.5F + mosaic(print, 0.016F, 0.012F, grain + 7));
  return m.colour * ((1.0F + flutes + board - edge - 0.55F * mark) * (1.0F + 0.12F * tape) *
                     marked(p, m, 0.35F));
}

// Backs of books and folders: a column each, with its own colour, height and title.
Colour books(const Rectangle& r, const TexturePoint& p) {
  constexpr float kBack_m = 0.034F;
  const Material& m = r.material;
  const Grain grain = grain_of(m);
  const int book = floor_int(p.u_m / kBack_m);
  const std::uint32_t hash = hash_cell(book, 0, grain);
  const auto part = [&](std::uint32_t which) { return unit_float(scramble(hash + which)); };
  const Colour dye = Colour(part(0), part(1), part(2)).square();
  const Colour back = 0.4F * dye + 0.4F * dye.mean() + 0.02F;
  const float height_m = r.size_m.y() * (0.78F + 0.22F * part(3));
  const float above = beyond(p.v_m - height_m, p.footprint_m);
  const float gap = on_line(to_grid_line_m(p.u_m, kBack_m), 0.0015F, p.footprint_m);
  const float in_back_m = p.u_m - kBack_m * static_cast<float>(book);
  const float title =
      inside(in_back_m, 0.25F * kBack_m, 0.75F * kBack_m, p.footprint_m) *
      inside(p.v_m, 0.35F * height_m, 0.75F * height_m, p.footprint_m) *
      clamp01(0.4F + mosaic({p.v_m, p.u_m, p.footprint_m}, 0.006F, kBack_m, grain + 1));
  const Colour printed = mixed(back, m.second, 0.7F * title);
  return mixed(printed, Colour::Constant(0.01F), std::max(above, 0.8F * gap)) * marked(p, m, 0.3F);
}

// Which face: `number`, as LampFace.
Colour lamp(const Rectangle& r, const TexturePoint& p) {
  constexpr float kFrame_m = 0.025F;
  constexpr float kRib_m = 0.1F;
  constexpr float kHousing = 0.05F;  // of the light that the lamp gives
  const Eigen::Vector2f& size_m = r.size_m;
  const auto face = static_cast<LampFace>(r.material.number);
  if (face == LampFace::kRound) {
    const Eigen::Vector2f from_middle_m(p.u_m - 0.5F * size_m.x(), p.v_m - 0.5F * size_m.y());
    const float out_m = from_middle_m.norm() - 0.42F * size_m.minCoeff();
    return r.material.colour * lerp(1.0F, kHousing, beyond(out_m, p.footprint_m));
  }
  const float u = std::min(p.u_m, size_m.x() - p.u_m);
  const float v = std::min(p.v_m, size_m.y() - p.v_m);
  const float frame = 1.0F - beyond(std::min(u, v) - kFrame_m, p.footprint_m);
  const bool is_along_u = size_m.x() > size_m.y();
  const float along_m = is_along_u ? u : v;
  const float across_m = is_along_u ? v : u;
  float shade = 1.0F;
  if (face == LampFace::kRibbed || face == LampFace::kLouvre) {
    shade -= 0.35F * on_line(to_grid_line_m(along_m, kRib_m), 0.004F, p.footprint_m);
  }
  if (face == LampFace::kLouvre) {
    shade -= 0.35F * on_line(to_grid_line_m(across_m, kRib_m), 0.006F, p.footprint_m);
  }
  if (face == LampFace::kTubes) {
    const float from_tube_m = std::abs(across_m - 0.25F * size_m.minCoeff());
    shade = lerp(kHousing, 1.0F, on_line(from_tube_m, 0.1F * size_m.minCoeff(), p.footprint_m));
  }
  return r.material.colour * ((1.0F - 0.75F * frame) * shade);
}

namespace {

// Light through slats that hang side by side, turned a little, each by itself.
float through_slats(float x_m, float slat_m, const Grain& grain, float footprint_m) {
  const float slats = x_m / slat_m;
  const float phase = slats - static_cast<float>(floor_int(slats));
  const float bent = unit_float(hash_cell(floor_int(slats), 0, grain));
  return 1.0F - visible_share(slat_m, footprint_m) * (0.45F * phase + 0.2F * bent);
}

// What hangs before a window.
float dressing(const Material& m, const TexturePoint& p, const Grain& grain) {
  const int step = m.number / kNumDressings;
  const float breadth = 0.7F + 0.2F * static_cast<float>(step);
  const float cord = on_line(to_grid_line_m(p.u_m + 0.2F, 0.55F), 0.004F, p.footprint_m);
  switch (static_cast<Dressing>(m.number % kNumDressings)) {
    case Dressing::kFine:
      return through_slats(p.v_m, 0.025F * breadth, grain, p.footprint_m) * (1.0F - 0.5F * cord);
    case Dressing::kUpright:
      return through_slats(p.u_m, 0.09F * breadth, grain, p.footprint_m);
    case Dressing::kCurtain: {
      const TexturePoint stretched{p.u_m, 0.06F * p.v_m, p.footprint_m};
      const float folds = octave_noise(
          stretched, {.wavelength_m = 0.14F * breadth, .count = 3, .gain = 0.6F}, grain + 3);
      return 0.7F * (1.0F + 0.3F * folds);
    }
    case Dressing::kShade:
      return 0.85F + 0.03F * mosaic(p, 0.01F, 0.01F, grain + 4);
    default:
      return through_slats(p.v_m, 0.05F * breadth, grain, p.footprint_m) * (1.0F - 0.5F * cord);
  }
}

}  // namespace

// Which dressing: `number`.
Colour blinds(const Rectangle& r, const TexturePoint& p) {
  const Material& m = r.material;
  const Grain grain = grain_of(m);
  const float outside =
      0.25F * octave_noise(p, {.wavelength_m = 0.6F, .count = 3, .gain = 0.6F}, grain);
  const float sky = lerp(0.6F, 1.0F, clamp01(p.v_m / r.size_m.y()));
  return m.colour * (dressing(m, p, grain) * sky * (1.0F + outside));
}

// Sky over houses over trees, a little out of focus.
Colour window_view(const Rectangle& r, const TexturePoint& point) {
  const Material& m = r.material;
  const Grain grain = grain_of(m);
  const TexturePoint p{point.u_m, point.v_m, std::max(point.footprint_m, 0.004F)};
  const float height_m = r.size_m.y();
  const float cloud =
      0.12F * octave_noise(p, {.wavelength_m = 0.7F, .count = 4, .gain = 0.6F}, grain);
  const Colour sky = m.colour * (0.85F + 0.2F * clamp01(p.v_m / height_m) + cloud);
  const float block_m = 0.33F;
  const int block = floor_int(p.u_m / block_m);
  const float roof_m = height_m * (0.5F + 0.14F * grid_value(block, 1, grain + 10));
  const float panes = inside(to_grid_line_m(p.u_m, 0.045F), 0.008F, 1.0F, p.footprint_m) *
                      inside(to_grid_line_m(p.v_m, 0.06F), 0.012F, 1.0F, p.footprint_m);
  const float wall = 0.22F + 0.08F * grid_value(block, 2, grain + 10);
  const Colour house = Colour(0.9F, 0.95F, 1.0F) * (wall * (1.0F - 0.55F * panes));
  const float crown_m =
      height_m *
      (0.26F + 0.12F * octave_noise({p.u_m, 0.0F, p.footprint_m},
                                    {.wavelength_m = 0.4F, .count = 5, .gain = 0.6F}, grain + 20));
  const float leaves =
      octave_noise(p, {.wavelength_m = 0.12F, .count = 4, .gain = 0.75F}, grain + 30);
  const Colour tree = Colour(0.06F, 0.13F, 0.08F) * (1.0F + 0.5F * leaves);
  const Colour far = mixed(sky, house, beyond(roof_m - p.v_m, p.footprint_m));
  return mixed(far, tree, beyond(crown_m - p.v_m, p.footprint_m));
}

}  // namespace samewhere::twin
