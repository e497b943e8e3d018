#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace samewhere::twin {

// Deterministic noise on the plane for procedural textures. Everything here depends on its
// arguments only. Lengths in metres; `footprint_m` is the width of a pixel on the surface: detail
// that is finer fades out, so that far surfaces do not shimmer.

// Murmur3's finaliser: every bit of the input changes half of the output.
constexpr std::uint32_t scramble(std::uint32_t h) {
  h ^= h >> 16;
  h *= 0x85ebca6bU;
  h ^= h >> 13;
  h *= 0xc2b2ae35U;
  return h ^ (h >> 16);
}

// The same for 64 bits (splitmix64).
constexpr std::uint64_t scramble(std::uint64_t h) {
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ULL;
  h = (h ^ (h >> 27)) * 0x94d049bb133111ebULL;
  return h ^ (h >> 31);
}

constexpr std::uint32_t hash_cell(int x, int y, std::uint32_t seed) {
  return scramble(static_cast<std::uint32_t>(x) * 0x9e3779b1U +
                  static_cast<std::uint32_t>(y) * 0x85ebca77U + seed * 0xc2b2ae3dU);
}

constexpr float unit_float(std::uint32_t bits) {
  return static_cast<float>(bits >> 8) * (1.0F / 16777216.0F);
}

// Nearly normal with standard deviation 1, at most 3.5 away from 0: the sum of the four bytes.
constexpr float nearly_gaussian(std::uint32_t bits) {
  constexpr float kMean = 510.0F;
  constexpr float kDeviation = 147.8F;
  const std::uint32_t sum =
      (bits & 0xffU) + ((bits >> 8) & 0xffU) + ((bits >> 16) & 0xffU) + (bits >> 24);
  return (static_cast<float>(sum) - kMean) / kDeviation;
}

inline int floor_int(float x) {
  const int truncated = static_cast<int>(x);
  return truncated - static_cast<int>(static_cast<float>(truncated) > x);
}

inline float clamp01(float x) { return std::min(std::max(x, 0.0F), 1.0F); }
inline float lerp(float a, float b, float ratio) { return a + ratio * (b - a); }
inline float smoothstep(float x) { return x * x * (3.0F - 2.0F * x); }

// Share of a pixel centred at x that lies beyond an edge at 0.
inline float beyond(float x, float footprint_m) { return clamp01(x / footprint_m + 0.5F); }
// Share of a pixel centred at x inside [low, high].
inline float inside(float x, float low, float high, float footprint_m) {
  return clamp01((std::min(x - low, high - x)) / footprint_m + 0.5F);
}

// Share of a pixel at a distance from the middle of a line that the line covers.
inline float on_line(float distance_m, float half_width_m, float footprint_m) {
  const float most = std::min(1.0F, 2.0F * half_width_m / footprint_m);
  return std::min(clamp01((half_width_m - distance_m) / footprint_m + 0.5F), most);
}

// How much of detail of this wavelength a pixel still shows: 1 above two pixels, 0 below one.
inline float visible_share(float wavelength_m, float footprint_m) {
  return clamp01(wavelength_m / footprint_m - 1.0F);
}

// A random value in [-1, 1] at every point of the grid of whole numbers.
constexpr float grid_value(int x, int y, std::uint32_t seed) {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 0x9e3779b1U +
                    static_cast<std::uint32_t>(y) * 0x85ebca77U + seed * 0xc2b2ae3dU;
  h = (h ^ (h >> 15)) * 0x2c1b3c6dU;
  h = (h ^ (h >> 13)) * 0x297a2d39U;
  return static_cast<float>(static_cast<std::int32_t>(h)) * (1.0F / 2147483648.0F);
}

// Seeds of a pattern that look-alikes share in part. Values are (1 - own_ratio) common + own_ratio
// own, scaled so that the contrast stays; marks are own with a chance of own_ratio.
struct Grain {
  Grain(std::uint32_t common_seed, std::uint32_t own_seed, float ratio)
      : common(common_seed),
        own(own_seed),
        own_ratio(ratio),
        scale(1.0F / std::sqrt((1.0F - ratio) * (1.0F - ratio) + ratio * ratio)) {}

  std::uint32_t common;
  std::uint32_t own;
  float own_ratio;
  float scale;
};

// Another pattern of the same kind.
inline Grain operator+(Grain grain, std::uint32_t step) {
  grain.common += step;
  grain.own += step;
  return grain;
}

inline float grid_value(int x, int y, const Grain& grain) {
  const float common = grid_value(x, y, grain.common);
  if (grain.own_ratio <= 0.0F) return common;
  return grain.scale * lerp(common, grid_value(x, y, grain.own), grain.own_ratio);
}

inline std::uint32_t hash_cell(int x, int y, const Grain& grain) {
  if (grain.own_ratio > 0.0F) {
    const std::uint32_t own = hash_cell(x, y, grain.own);
    // one step of mixing: the bits decide other things, too
    if (unit_float(own * 0x9e3779b1U) < grain.own_ratio) return own;
  }
  return hash_cell(x, y, grain.common);
}

// Grid values blended by weights of the next column and row.
template <class Seed>
float blend_grid(int x, int y, const Seed& seed, float next_x, float next_y) {
  return lerp(lerp(grid_value(x, y, seed), grid_value(x + 1, y, seed), next_x),
              lerp(grid_value(x, y + 1, seed), grid_value(x + 1, y + 1, seed), next_x), next_y);
}

// Soft hills and hollows of a size of about 1.
template <class Seed>
float value_noise(float x, float y, const Seed& seed) {
  const int ix = floor_int(x);
  const int iy = floor_int(y);
  return blend_grid(ix, iy, seed, smoothstep(x - static_cast<float>(ix)),
                    smoothstep(y - static_cast<float>(iy)));
}

// A point on a textured surface.
struct TexturePoint {
  float u_m = 0.0F;  // to the right, seen from the corridor
  float v_m = 0.0F;  // upwards
  float footprint_m = 0.0F;
};

// Octaves of value noise, each half as long as the one before.
struct Octaves {
  float wavelength_m = 1.0F;  // of the first
  int count = 4;
  float gain = 0.5F;  // amplitude of each over the one before
};

template <class Seed>
float octave_noise(const TexturePoint& p, const Octaves& octaves, const Seed& seed) {
  float sum = 0.0F;
  float amplitude = 1.0F;
  float frequency_per_m = 1.0F / octaves.wavelength_m;
  float pixels = octaves.wavelength_m / p.footprint_m;  // per wavelength
  for (int i = 0; i < octaves.count && pixels > 1.0F; ++i) {
    sum += amplitude * std::min(pixels - 1.0F, 1.0F) *
           value_noise(p.u_m * frequency_per_m, p.v_m * frequency_per_m,
                       seed + static_cast<std::uint32_t>(i));
    amplitude *= octaves.gain;
    frequency_per_m *= 2.0F;
    pixels *= 0.5F;
  }
  return sum;
}

// Light and shade of a rough surface lit from above: slopes upwards of octaves of value noise, in
// the same numbers as the octaves' own values.
template <class Seed>
float octave_slope(const TexturePoint& p, const Octaves& octaves, const Seed& seed) {
  float sum = 0.0F;
  float amplitude = 1.0F;
  float frequency_per_m = 1.0F / octaves.wavelength_m;
  float pixels = octaves.wavelength_m / p.footprint_m;  // per wavelength
  for (int i = 0; i < octaves.count && pixels > 1.0F; ++i) {
    // grids turned one way and the other, or their rows would show
    const float turn = (i & 1) == 0 ? 0.6F : -0.6F;
    const float x = (0.8F * p.u_m + turn * p.v_m) * frequency_per_m;
    const float y = (0.8F * p.v_m - turn * p.u_m) * frequency_per_m;
    const int ix = floor_int(x);
    const int iy = floor_int(y);
    const float next_x = smoothstep(x - static_cast<float>(ix));
    const float up = y - static_cast<float>(iy);
    const Seed octave = seed + static_cast<std::uint32_t>(i);
    const float below = lerp(grid_value(ix, iy, octave), grid_value(ix + 1, iy, octave), next_x);
    const float above =
        lerp(grid_value(ix, iy + 1, octave), grid_value(ix + 1, iy + 1, octave), next_x);
    sum += amplitude * std::min(pixels - 1.0F, 1.0F) * 6.0F * up * (1.0F - up) * (above - below);
    amplitude *= octaves.gain;
    frequency_per_m *= 2.0F;
    pixels *= 0.5F;
  }
  return sum;
}

// A mosaic of flat rectangles with random values in [-1, 1], their edges as soft as a pixel.
template <class Seed>
float mosaic(const TexturePoint& p, float width_m, float height_m, const Seed& seed) {
  const float shorter_m = std::min(width_m, height_m);
  const float share = visible_share(shorter_m, p.footprint_m);
  if (share <= 0.0F) return 0.0F;
  const float u = p.u_m / width_m;
  const float v = p.v_m / height_m;
  const int iu = floor_int(u);
  const int iv = floor_int(v);
  const float sharpness = std::min(shorter_m / p.footprint_m, 20.0F);
  const float next_u = clamp01((u - static_cast<float>(iu) - 0.5F) * sharpness + 0.5F);
  const float next_v = clamp01((v - static_cast<float>(iv) - 0.5F) * sharpness + 0.5F);
  return share * blend_grid(iu, iv, seed, next_u, next_v);
}

// Marks strewn over the surface, at most one in each cell of a grid.
struct Strewn {
  float cell_m = 0.1F;
  float density = 0.3F;  // share of cells that hold a mark
};

// Coverage in [0, 1] by round spots of random size and strength.
template <class Seed>
float spots(const TexturePoint& p, const Strewn& strewn, const Seed& seed);
// Coverage in [0, 1] by thin straight strokes of random direction, length and strength.
template <class Seed>
float scratches(const TexturePoint& p, const Strewn& strewn, const Seed& seed);

}  // namespace samewhere::twin
