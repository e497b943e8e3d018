#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <samewhere/twin/building/furnisher.hpp>
#include <samewhere/twin/building/noise.hpp>
#include <samewhere/twin/building/piece.hpp>

namespace samewhere::twin {
namespace {

Eigen::Vector3f right_of(const Wall& wall) {
  const Eigen::Vector2f along = (wall.to_m - wall.from_m).normalized();
  return {along.x(), along.y(), 0.0F};
}

// Tells the planes of walls apart, to a centimetre: pieces of one plane have one pattern.
std::uint32_t plane_of(const Wall& wall) {
  const Eigen::Vector3f right = right_of(wall);
  const Eigen::Vector2f normal(right.y(), -right.x());
  const auto heading = static_cast<int>(std::lround(std::atan2(normal.y(), normal.x()) * 100.0F));
  const auto distance = static_cast<int>(std::lround(wall.from_m.dot(normal) * 100.0F));
  return hash_cell(heading, distance, 1);
}

constexpr std::uint32_t kFloorPlane = 2;
constexpr std::uint32_t kCeilingPlane = 3;

// Walls of bricks may be built or covered otherwise; paint is that of the walls or of their dados.
Material stair_wall(const Piece& piece, std::uint32_t plane) {
  constexpr std::array kFinishes = {Finish::kBrick, Finish::kWall, Finish::kPlaster,
                                    Finish::kConcrete};
  const Palette& palette = piece.palette();
  Choices choices(palette.stair_design);
  const Finish finish = choices.of(kFinishes);
  // of one colour: a dado would have to follow the steps
  const Colour& coat = choices.next(2) == 0 ? palette.dado : palette.wall;
  Material material = piece.running(finish, coat, coat, plane);
  material.pattern_seed = scramble(material.pattern_seed + palette.stair_design);
  return material;
}

Material wall_material(const Piece& piece, WallFinish finish, std::uint32_t plane) {
  const Palette& palette = piece.palette();
  switch (finish) {
    case WallFinish::kBlocks:
      return piece.running(Finish::kWall, palette.wall, palette.dado, plane);
    case WallFinish::kPlaster:
      return piece.running(Finish::kPlaster, palette.wall, palette.dado, plane);
    case WallFinish::kConcrete:
      return piece.running(Finish::kConcrete, 0.8F * palette.floor, palette.joint, plane);
    case WallFinish::kBrick:
      return stair_wall(piece, plane);
  }
  return piece.running(Finish::kWall, palette.wall, palette.dado, plane);
}

// Another design is another pattern: look-alikes with unlike ceilings do not count as alike.
Material tiled_ceiling(const Piece& piece) {
  const Palette& palette = piece.palette();
  const bool is_plastered = palette.ceiling_kind == kPlasteredCeiling;
  Material material = piece.running(is_plastered ? Finish::kCeilingPlaster : Finish::kCeiling,
                                    palette.ceiling, paints::kWhite, kCeilingPlane);
  material.pattern_seed = scramble(material.pattern_seed + palette.ceiling_design);
  material.number = palette.ceiling_kind;
  return material;
}

// A stain or deep scratch: a piece of the wall a hair in front of it.
void add_blot(Piece& piece, const Box& span, Material material) {
  constexpr float kHair_m = 6e-4F;
  core::Random random(piece.draws().own_seed());
  const auto size_m = static_cast<float>(random.uniform(0.18, 0.4));
  const Eigen::Vector3f room = span.high_m - span.low_m;
  const auto x_m = static_cast<float>(random.uniform(0.0, room.x() - size_m));
  const auto y_m = static_cast<float>(random.uniform(0.0, room.y() - size_m));
  material.blot_seed = piece.draws().own_seed() | 1U;
  piece.begin_object("blot " + std::to_string(material.blot_seed), true);
  piece.add_panel(
      {.corner_m = span.low_m + Eigen::Vector3f(x_m, y_m, kHair_m), .size_m = {size_m, size_m}},
      material);
  piece.end_object();
}

}  // namespace

Furnisher::Furnisher(Building& building, int unit, const Style& style, const LightSetting& light)
    : building_(building), unit_(unit), style_(style), light_(light), palette_(style) {}

Piece Furnisher::piece_at(const Stance& stand) {
  return Piece({building_, unit_, style_, light_, palette_, num_things_++}, stand);
}

Piece Furnisher::piece_at(const Wall& wall) { return piece_at(Place{wall, 0.0F}); }

Piece Furnisher::piece_at(const Place& place) {
  const Eigen::Vector3f right = right_of(place.wall);
  const Eigen::Vector3f start_m(place.wall.from_m.x(), place.wall.from_m.y(), place.wall.floor_m);
  return piece_at(stand_of(start_m + place.along_m * right, right, Eigen::Vector3f::UnitZ()));
}

Piece Furnisher::piece_at(const Spot& spot) {
  const Eigen::Vector3f front(std::cos(spot.heading_rad), std::sin(spot.heading_rad), 0.0F);
  const Eigen::Vector3f up = Eigen::Vector3f::UnitZ();
  return piece_at(stand_of(spot.position_m, up.cross(front), up));
}

// Out is down; right is the unit's x.
Piece Furnisher::piece_below(const Eigen::Vector2f& middle_m, float ceiling_m) {
  return piece_at(stand_of({middle_m.x(), middle_m.y(), ceiling_m}, Eigen::Vector3f::UnitX(),
                           -Eigen::Vector3f::UnitY()));
}

void Furnisher::add_wall(const Wall& wall, float low_m, float high_m, WallFinish finish) {
  constexpr float kPerBlot_m = 7.0F;
  constexpr float kShortest_m = 1.5F;
  Piece piece = piece_at(wall);
  const Material material = wall_material(piece, finish, plane_of(wall));
  const float long_m = wall.length_m();
  const Box span{{0.0F, low_m - wall.floor_m, 0.0F}, {long_m, high_m - wall.floor_m, 0.0F}};
  const std::size_t first = building_.rectangles.size();
  piece.add_panel({.corner_m = span.low_m, .size_m = {long_m, high_m - low_m}}, material);
  // walls in one plane share their pattern
  const Eigen::Vector2f right = right_of(wall).head<2>();
  const float start_m = right.dot(wall.from_m);
  building_.rectangles[first].pattern_m.x() = start_m;
  if (long_m < kShortest_m || high_m - low_m < kShortest_m) return;
  const auto num_blots = static_cast<int>(long_m / kPerBlot_m + piece.draws().blend(0.0F, 1.0F));
  for (int i = 0; i < num_blots; ++i) {
    const std::size_t blot = building_.rectangles.size();
    add_blot(piece, span, material);
    building_.rectangles[blot].pattern_m.x() += start_m;
  }
}

void Furnisher::add_floor(const Eigen::Vector2f& low_m, const Eigen::Vector2f& high_m, float z_m,
                          FloorFinish finish) {
  Piece piece = piece_at(Stance{});
  const Palette& p = palette_;
  const auto material = [&] {
    switch (finish) {
      case FloorFinish::kCarpet:
        return piece.running(Finish::kCarpet, p.carpet, p.fleck, kFloorPlane);
      case FloorFinish::kTiles:
        return piece.running(Finish::kFloorTiles, p.floor, p.joint, kFloorPlane);
      case FloorFinish::kConcrete:
        return piece.running(Finish::kConcrete, 0.75F * p.floor, p.joint, kFloorPlane);
      case FloorFinish::kWood:
        return piece.running(Finish::kPlanks, p.wood, 0.5F * p.wood, kFloorPlane);
    }
    return piece.running(Finish::kCarpet, p.carpet, p.fleck, kFloorPlane);
  }();
  piece.add_panel({.corner_m = {low_m.x(), low_m.y(), z_m}, .size_m = high_m - low_m}, material);
}

void Furnisher::add_ceiling(const Eigen::Vector2f& low_m, const Eigen::Vector2f& high_m, float z_m,
                            CeilingFinish finish) {
  Piece piece = piece_at(Stance{});
  const Colour& colour = palette_.ceiling;
  const auto material = [&] {
    switch (finish) {
      case CeilingFinish::kTiles:
        return tiled_ceiling(piece);
      case CeilingFinish::kPlaster:
        return piece.running(Finish::kCeilingPlaster, colour, colour, kCeilingPlane);
      case CeilingFinish::kConcrete:
        return piece.running(Finish::kConcrete, 0.7F * colour, 0.5F * colour, kCeilingPlane);
    }
    return tiled_ceiling(piece);
  }();
  piece.add_panel({.corner_m = {low_m.x(), high_m.y(), z_m},
                   .up = -Eigen::Vector3f::UnitY(),
                   .size_m = high_m - low_m},
                  material);
}

void Furnisher::add_skirting(const Wall& wall, float from_along_m, float to_along_m) {
  Piece piece = piece_at(wall);
  const Material material = piece.made_of(Finish::kPaint, palette_.skirting);
  piece.add_box({{from_along_m, 0.0F, 0.0F}, {to_along_m, palette_.skirting_m, 0.012F}},
                {material, material});
}

void Furnisher::add_cornice(const Wall& wall, float width_m, float height_m) {
  Piece piece = piece_at(wall);
  const Material white = piece.made_of(Finish::kPaint, palette_.ceiling);
  const float top_m = wall.ceiling_m - wall.floor_m;
  const float long_m = wall.length_m();
  // where two walls meet, the faces of one are a hair beside those of the other
  const bool is_along_x = std::abs(right_of(wall).x()) > 0.5F;
  const float hair_m = is_along_x ? 0.001F : 0.002F;
  piece.add_box({{0.0F, top_m - height_m - hair_m, 0.0F}, {long_m, top_m + hair_m, width_m}},
                {white, white});
}

void Furnisher::add_cable_duct(const Wall& wall, float below_m) {
  Piece piece = piece_at(wall);
  const Colour grey = colour_of_srgb(0.80F, 0.80F, 0.78F);
  const Material material = piece.made_of(Finish::kPlastic, grey);
  const float top_m = wall.ceiling_m - wall.floor_m - below_m;
  piece.add_box({{0.0F, top_m - 0.05F, 0.0F}, {wall.length_m(), top_m, 0.035F}},
                {material, material});
}

void Furnisher::add_handrail(const Wall& wall, float rise_m) {
  constexpr float kHeight_m = 0.9F;
  constexpr float kOut_m = 0.075F;
  constexpr float kPerBracket_m = 1.0F;
  Piece piece = piece_at(wall);
  const float long_m = wall.length_m();
  const Material rail = piece.made_of(Finish::kWood, palette_.wood);
  const Material steel = piece.made_of(Finish::kSteel, paints::kMetal);
  piece.begin_object("handrail");
  piece.add_bar({.from_m = {0.02F, kHeight_m, kOut_m},
                 .to_m = {long_m - 0.02F, kHeight_m + rise_m, kOut_m},
                 .radius_m = 0.021F,
                 .num_sides = 10,
                 .has_ends = true},
                rail);
  const auto num_brackets = std::max(2, static_cast<int>(long_m / kPerBracket_m) + 1);
  for (int i = 0; i < num_brackets; ++i) {
    const float ratio = (static_cast<float>(i) + 0.5F) / static_cast<float>(num_brackets);
    const Eigen::Vector2f at(ratio * long_m, kHeight_m + ratio * rise_m - 0.05F);
    piece.add_box(centred(at, {0.05F, 0.05F}, {0.0F, 0.006F}), {steel, steel});
    piece.add_bar({.from_m = {at.x(), at.y(), 0.0F},
                   .to_m = {at.x(), at.y() + 0.04F, kOut_m},
                   .radius_m = 0.006F,
                   .num_sides = 6},
                  steel);
  }
  piece.end_object();
}

void Furnisher::add_pipes(const Wall& wall, float height_m) {
  constexpr float kPerClamp_m = 1.4F;
  Piece piece = piece_at(wall);
  const float long_m = wall.length_m();
  const Material steel = piece.made_of(Finish::kSteel, paints::kMetal);
  const Colour coats[] = {0.9F * paints::kWhite, paints::kGrey, 0.7F * paints::kMetal,
                          0.6F * paints::kRed + 0.2F * paints::kGrey, paints::kGreen};
  const int num_pipes = 2 + piece.draws().pick(2);
  float y_m = height_m;
  piece.begin_object("pipes");
  for (int i = 0; i < 3; ++i) {
    const float radius_m = piece.draws().blend(0.014F, 0.045F);
    const Material coat = piece.made_of(Finish::kPaint, piece.draws().blend(coats));
    if (i >= num_pipes) continue;
    y_m += radius_m;
    const float out_m = 0.03F + radius_m;
    piece.add_bar({.from_m = {0.0F, y_m, out_m},
                   .to_m = {long_m, y_m, out_m},
                   .radius_m = radius_m,
                   .num_sides = 12},
                  coat);
    for (float x_m = 0.4F; x_m < long_m; x_m += kPerClamp_m) {
      const Eigen::Vector3f half(0.015F, 0.0F, 0.0F);
      const Eigen::Vector3f middle(x_m, y_m, out_m);
      piece.add_bar({.from_m = middle - half,
                     .to_m = middle + half,
                     .radius_m = radius_m + 0.003F,
                     .num_sides = 12},
                    steel);
      piece.add_box(centred({x_m, y_m}, {0.02F, 0.02F}, {0.0F, 0.03F}), {steel, steel});
    }
    y_m += radius_m + 0.05F;
  }
  piece.end_object();
}

}  // namespace samewhere::twin
