#include <samewhere/twin/building/noise.hpp>

namespace samewhere::twin {
namespace {

// The cell of a grid that a point lies in, and where in it.
struct Cell {
  float x = 0.0F;  // in [0, 1)
  float y = 0.0F;
  std::uint32_t hash = 0;
};

template <class Seed>
Cell cell_at(const TexturePoint& p, float cell_m, const Seed& seed) {
  const float u = p.u_m / cell_m;
  const float v = p.v_m / cell_m;
  const int iu = floor_int(u);
  const int iv = floor_int(v);
  return {u - static_cast<float>(iu), v - static_cast<float>(iv), hash_cell(iu, iv, seed)};
}

float byte_ratio(std::uint32_t hash, int byte) {
  return static_cast<float>((hash >> (8 * byte)) & 0xffU) * (1.0F / 255.0F);
}

}  // namespace

template <class Seed>
float spots(const TexturePoint& p, const Strewn& strewn, const Seed& seed) {
  const float pixel = p.footprint_m / strewn.cell_m;
  if (pixel > 0.6F) return 0.0F;
  const Cell cell = cell_at(p, strewn.cell_m, seed);
  if (byte_ratio(cell.hash, 0) > strewn.density) return 0.0F;
  const float radius = 0.08F + 0.27F * byte_ratio(cell.hash, 1) * byte_ratio(cell.hash, 1);
  const float room = 1.0F - 2.0F * radius;  // the spot stays inside its cell
  const float dx = cell.x - radius - room * byte_ratio(cell.hash, 2);
  const float dy = cell.y - radius - room * byte_ratio(cell.hash, 3);
  const float width = std::max(pixel, 0.06F);
  const float strength = 0.35F + 0.65F * unit_float(scramble(cell.hash));
  const float filtered = std::min(1.0F, 2.0F * radius / width);
  return strength * filtered * clamp01((radius - std::sqrt(dx * dx + dy * dy)) / width + 0.5F);
}

template <class Seed>
float scratches(const TexturePoint& p, const Strewn& strewn, const Seed& seed) {
  const float pixel = p.footprint_m / strewn.cell_m;
  if (pixel > 0.3F) return 0.0F;
  const Cell cell = cell_at(p, strewn.cell_m, seed);
  if (byte_ratio(cell.hash, 0) > strewn.density) return 0.0F;
  const float along_u = 2.0F * byte_ratio(cell.hash, 1) - 1.0F;
  const float along_v = std::sqrt(1.0F - along_u * along_u);
  const float half_length = 0.1F + 0.33F * byte_ratio(cell.hash, 2);
  const float half_width = 0.008F + 0.02F * byte_ratio(cell.hash, 3);
  const float dx = cell.x - 0.5F;
  const float dy = cell.y - 0.5F;
  const float along = std::abs(dx * along_u + dy * along_v) - half_length;
  const float across = std::abs(dy * along_u - dx * along_v) - half_width;
  const float width = std::max(pixel, 0.01F);
  const float strength = 0.3F + 0.7F * unit_float(scramble(cell.hash));
  const float filtered = std::min(1.0F, 2.0F * half_width / width);
  return strength * filtered * clamp01(0.5F - along / width) * clamp01(0.5F - across / width);
}

template float spots(const TexturePoint&, const Strewn&, const std::uint32_t&);
template float spots(const TexturePoint&, const Strewn&, const Grain&);
template float scratches(const TexturePoint&, const Strewn&, const std::uint32_t&);
template float scratches(const TexturePoint&, const Strewn&, const Grain&);

}  // namespace samewhere::twin
