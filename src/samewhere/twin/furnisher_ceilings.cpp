#include <cmath>

#include <samewhere/twin/furnisher.hpp>
#include <samewhere/twin/piece.hpp>

namespace samewhere::twin {
namespace {

constexpr float kLampRadiance = 13.0F;

}  // namespace

void Furnisher::add_ceiling_lamp(const Eigen::Vector2f& middle_m, const Eigen::Vector2f& size_m,
                                 float ceiling_m) {
  Piece piece = piece_below(middle_m, ceiling_m);
  Material light = piece.made_of(Finish::kLamp, paints::kLampWhite);
  light.radiance = kLampRadiance * piece.light().lamps;
  const Material white = piece.made_of(Finish::kPaint, paints::kWhite);
  piece.begin_object("lamp");
  piece.add_box(centred({0.0F, 0.0F}, size_m, {0.0F, 0.03F}), {light, white});
  piece.end_object();
}

void Furnisher::add_high_bay_lamp(const Eigen::Vector2f& middle_m, float ceiling_m) {
  constexpr float kDrop_m = 0.5F;
  Piece piece = piece_below(middle_m, ceiling_m);
  Material light = piece.made_of(Finish::kLamp, paints::kLampWhite);
  // lights a hall from high up
  light.radiance = 16.0F * kLampRadiance * piece.light().lamps;
  const Material body = piece.made_of(Finish::kPaint, paints::kGrey);
  piece.begin_object("high bay lamp");
  piece.add_bar({.to_m = {0.0F, 0.0F, kDrop_m}, .radius_m = 0.008F, .num_sides = 6}, body);
  piece.add_block({{-0.16F, -0.16F, kDrop_m}, {0.16F, 0.16F, kDrop_m + 0.22F}}, body);
  piece.add_box(centred({0.0F, 0.0F}, {0.52F, 0.52F}, {kDrop_m + 0.22F, kDrop_m + 0.26F}),
                {light, body});
  piece.add_panel({.corner_m = {-0.26F, 0.26F, kDrop_m + 0.22F},
                   .right = Eigen::Vector3f::UnitX(),
                   .up = -Eigen::Vector3f::UnitY(),
                   .size_m = {0.52F, 0.52F}},
                  body);
  piece.end_object();
}

void Furnisher::add_ceiling_vent(const Eigen::Vector2f& middle_m, float ceiling_m) {
  Piece piece = piece_below(middle_m, ceiling_m);
  const Material slots = piece.made_of(Finish::kGrille, paints::kWhite);
  const Material white = piece.made_of(Finish::kPaint, paints::kWhite);
  piece.begin_object("vent");
  piece.add_box(centred({0.0F, 0.0F}, {0.48F, 0.48F}, {0.0F, 0.012F}), {slots, white});
  piece.end_object();
}

void Furnisher::add_smoke_detector(const Eigen::Vector2f& middle_m, float ceiling_m) {
  Piece piece = piece_below(middle_m, ceiling_m);
  const Material white = piece.made_of(Finish::kPlastic, paints::kWhite);
  const Material red = piece.made_of(Finish::kPlastic, paints::kRed);
  piece.begin_object("smoke detector");
  piece.add_bar(
      {.to_m = {0.0F, 0.0F, 0.025F}, .radius_m = 0.055F, .num_sides = 12, .has_ends = true}, white);
  piece.add_bar({.from_m = {0.0F, 0.0F, 0.025F},
                 .to_m = {0.0F, 0.0F, 0.05F},
                 .radius_m = 0.035F,
                 .num_sides = 12,
                 .has_ends = true},
                white);
  piece.add_box(centred({0.042F, 0.0F}, {0.006F, 0.006F}, {0.025F, 0.028F}), {red, red});
  piece.end_object();
}

void Furnisher::add_exit_sign(const Eigen::Vector2f& middle_m, float heading_rad, float ceiling_m) {
  constexpr float kBottom_m = -0.30F;
  constexpr float kTop_m = -0.08F;
  Piece piece = piece_at(Spot{{middle_m.x(), middle_m.y(), ceiling_m}, heading_rad});
  Material sign = piece.made_of(Finish::kSign, paints::kGreen, paints::kWhite);
  const Material white = piece.made_of(Finish::kPlastic, paints::kWhite);
  const Material steel = piece.made_of(Finish::kSteel, paints::kMetal);
  piece.begin_object("exit sign");
  const Box body{{-0.25F, kBottom_m, -0.015F}, {0.25F, kTop_m, 0.015F}};
  piece.add_box(body, {sign, white});
  piece.add_panel({.corner_m = {0.25F, kBottom_m, -0.015F},
                   .right = -Eigen::Vector3f::UnitX(),
                   .size_m = {0.5F, kTop_m - kBottom_m}},
                  sign);
  for (const float x_m : {-0.18F, 0.18F}) {
    piece.add_bar({.from_m = {x_m, kTop_m, 0.0F},
                   .to_m = {x_m, 0.0F, 0.0F},
                   .radius_m = 0.006F,
                   .num_sides = 6},
                  steel);
  }
  piece.end_object();
}

}  // namespace samewhere::twin
