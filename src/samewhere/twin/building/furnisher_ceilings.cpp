#include <algorithm>
#include <array>

#include <samewhere/twin/building/furnisher.hpp>
#include <samewhere/twin/building/piece.hpp>

namespace samewhere::twin {
namespace {

constexpr float kLampRadiance = 13.0F;

}  // namespace

void Furnisher::add_ceiling_lamp(const Eigen::Vector2f& middle_m, const LampFitting& fitting,
                                 float ceiling_m) {
  constexpr float kThick_m = 0.03F;
  Piece piece = piece_below(middle_m, ceiling_m);
  Material light = piece.made_of(Finish::kLamp, paints::kLampWhite);
  const float brightness = std::clamp(fitting.usual_m2 / fitting.size_m.prod(), 0.5F, 4.0F);
  light.radiance = kLampRadiance * brightness * piece.light().lamps;
  light.number = static_cast<int>(fitting.face);
  const Material white = piece.made_of(Finish::kPaint, paints::kWhite);
  const Material steel = piece.made_of(Finish::kSteel, paints::kMetal);
  piece.begin_object("lamp");
  const float drop_m = fitting.drop_m;
  const float thick_m = drop_m > 0.0F ? 2.0F * kThick_m : kThick_m;
  const Box body = centred({0.0F, 0.0F}, fitting.size_m, {drop_m, drop_m + thick_m});
  piece.add_box(body, {light, white});
  if (drop_m > 0.0F) {
    piece.add_panel({.corner_m = {body.low_m.x(), body.high_m.y(), drop_m},
                     .up = -Eigen::Vector3f::UnitY(),
                     .size_m = fitting.size_m},
                    white);
    for (const float side : {-0.4F, 0.4F}) {
      const Eigen::Vector2f at = side * fitting.size_m;
      piece.add_bar({.to_m = {at.x(), at.y(), drop_m}, .radius_m = 0.004F, .num_sides = 6}, steel);
    }
  }
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

void Furnisher::add_ceiling_vent(const Eigen::Vector2f& middle_m, VentKind kind, float ceiling_m) {
  Piece piece = piece_below(middle_m, ceiling_m);
  const Material slots = piece.made_of(Finish::kGrille, paints::kWhite);
  const Material white = piece.made_of(Finish::kPaint, paints::kWhite);
  const Material black = piece.made_of(Finish::kPlastic, paints::kBlack);
  piece.begin_object("vent");
  if (kind == VentKind::kGrille) {
    piece.add_box(centred({0.0F, 0.0F}, {0.48F, 0.48F}, {0.0F, 0.012F}), {slots, white});
  } else if (kind == VentKind::kSlot) {
    piece.add_box(centred({0.0F, 0.0F}, {0.14F, 0.9F}, {0.0F, 0.008F}), {white, white});
    for (const float x_m : {-0.03F, 0.03F}) {
      piece.add_box(centred({x_m, 0.0F}, {0.025F, 0.84F}, {0.008F, 0.0085F}), {black, black});
    }
  } else {
    constexpr std::array kRings_m = {0.16F, 0.11F, 0.06F};
    float out_m = 0.0F;
    for (const float radius_m : kRings_m) {
      piece.add_bar({.from_m = {0.0F, 0.0F, out_m},
                     .to_m = {0.0F, 0.0F, out_m + 0.015F},
                     .radius_m = radius_m,
                     .num_sides = 12,
                     .has_ends = true},
                    out_m > 0.02F ? black : white);
      out_m += 0.015F;
    }
  }
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
  Piece piece = piece_at(Spot{{middle_m.x(), middle_m.y(), ceiling_m}, heading_rad});
  const std::array<Eigen::Vector2f, 4> sizes_m = {
      {{0.5F, 0.22F}, {0.36F, 0.18F}, {0.30F, 0.30F}, {0.62F, 0.20F}}};
  constexpr std::array kDrops_m = {0.08F, 0.02F, 0.16F};
  Choices choices(piece.draws().design());
  const Eigen::Vector2f size_m = choices.of(sizes_m);
  const float top_m = -choices.of(kDrops_m);
  const float rod_m = 0.36F * size_m.x() * static_cast<float>(choices.next(2));
  const bool is_white = choices.next(3) == 0;
  const Colour ground = is_white ? paints::kWhite : paints::kGreen;
  Material sign =
      piece.made_of(Finish::kSign, ground, is_white ? 0.8F * paints::kGreen : paints::kWhite);
  const Material white = piece.made_of(Finish::kPlastic, paints::kWhite);
  const Material steel = piece.made_of(Finish::kSteel, paints::kMetal);
  piece.begin_object("exit sign");
  const float bottom_m = top_m - size_m.y();
  const float half_m = 0.5F * size_m.x();
  piece.add_box({{-half_m, bottom_m, -0.015F}, {half_m, top_m, 0.015F}}, {sign, white});
  piece.add_panel({.corner_m = {half_m, bottom_m, -0.015F},
                   .right = -Eigen::Vector3f::UnitX(),
                   .size_m = size_m},
                  sign);
  for (const float x_m : {-rod_m, rod_m}) {
    piece.add_bar({.from_m = {x_m, top_m, 0.0F},
                   .to_m = {x_m, 0.0F, 0.0F},
                   .radius_m = 0.006F,
                   .num_sides = 6},
                  steel);
    if (rod_m == 0.0F) break;
  }
  piece.end_object();
}

}  // namespace samewhere::twin
