#include <samewhere/twin/building/clutter.hpp>
#include <samewhere/twin/building/furnisher.hpp>
#include <samewhere/twin/building/piece.hpp>

namespace samewhere::twin {
namespace {

// However alike: about one print of its own in six metres of corridor.
constexpr double kMinOwnSheet = 0.07;
constexpr double kMinOwnPoster = 0.2;

}  // namespace

void Furnisher::add_notice_board(const Place& place) {
  Piece piece = piece_at(place);
  Draws& draws = piece.draws();
  const Colour cloths[] = {paints::kCork, paints::kCork, 0.8F * paints::kBlue,
                           0.7F * paints::kGreen, paints::kGrey};
  const Material cork = piece.made_of(Finish::kCork, draws.blend(cloths));
  const Material frame = piece.made_of(Finish::kWood, palette_.wood);
  const Box board = centred({0.0F, 1.52F}, {1.12F, 0.84F}, {0.0F, 0.015F});
  piece.begin_object("notice board");
  piece.add_box(board, {cork, cork});
  Box around = board;
  around.high_m.z() = 0.025F;
  piece.add_frame(around, 0.03F, frame);
  piece.end_object();
  constexpr int kNumColumns = 4;
  constexpr int kNumSlots = 8;
  for (int slot = 0; slot < kNumSlots; ++slot) {
    piece.begin_part(slot);
    const Eigen::Vector2f shift_m{draws.shift(0.03F), draws.shift(0.035F)};
    const bool is_wide = draws.happens(0.3);
    const bool is_there = draws.happens(0.85);
    const auto column = static_cast<float>(slot % kNumColumns);
    const int row_index = slot / kNumColumns;
    const auto row = static_cast<float>(row_index);
    const Eigen::Vector2f middle_m(-0.41F + 0.27F * column, 1.32F + 0.4F * row);
    // never two at one depth: they may overlap
    const float out_m = 0.0155F + 0.0004F * static_cast<float>(slot);
    const Eigen::Vector2f size_m =
        is_wide ? Eigen::Vector2f(0.24F, 0.17F) : Eigen::Vector2f(0.21F, 0.297F);
    if (is_there) {
      piece.add_paper(centred(middle_m + shift_m, size_m, {0.015F, out_m}), kMinOwnSheet);
    }
  }
}

void Furnisher::add_framed_poster(const Place& place) {
  Piece piece = piece_at(place);
  const Colour frames[] = {paints::kBlack, paints::kMetal, paints::kWhite, palette_.wood};
  const Material frame = piece.made_of(Finish::kPaint, piece.draws().blend(frames));
  const float up_m = piece.draws().shift(0.03F);
  const Box sheet = centred({0.0F, 1.55F + up_m}, {0.6F, 0.84F}, {0.0F, 0.012F});
  piece.add_paper(sheet, kMinOwnPoster, Cover::kGlass);
  Box around = sheet;
  around.high_m.z() = 0.022F;
  piece.begin_object("picture frame");
  piece.add_frame(around, 0.02F, frame);
  piece.end_object();
}

void Furnisher::add_extinguisher(const Place& place) {
  Piece piece = piece_at(place);
  const Material red = piece.made_of(Finish::kPaint, paints::kRed);
  const Material black = piece.made_of(Finish::kPlastic, paints::kBlack);
  const Material steel = piece.made_of(Finish::kSteel, paints::kMetal);
  const Material label = piece.made_of(Finish::kLabel, paints::kWhite, paints::kRed);
  Material sign = piece.made_of(Finish::kSign, paints::kRed, paints::kWhite);
  sign.number = static_cast<int>(Pictogram::kExtinguisher);
  constexpr float kOut_m = 0.105F;
  piece.begin_object("extinguisher");
  piece.add_bar({.from_m = {0.0F, 0.5F, kOut_m},
                 .to_m = {0.0F, 0.98F, kOut_m},
                 .radius_m = 0.078F,
                 .num_sides = 12,
                 .has_ends = true},
                red);
  piece.add_bar({.from_m = {0.0F, 0.98F, kOut_m},
                 .to_m = {0.0F, 1.04F, kOut_m},
                 .radius_m = 0.03F,
                 .num_sides = 8,
                 .has_ends = true},
                steel);
  piece.add_block({{-0.06F, 1.04F, kOut_m - 0.012F}, {0.05F, 1.06F, kOut_m + 0.012F}}, black);
  piece.add_bar({.from_m = {0.03F, 1.03F, kOut_m},
                 .to_m = {0.1F, 0.72F, kOut_m + 0.03F},
                 .radius_m = 0.011F,
                 .num_sides = 6,
                 .has_ends = true},
                black);
  piece.add_box(centred({0.0F, 0.76F}, {0.09F, 0.16F}, {kOut_m, kOut_m + 0.083F}), {label, label});
  piece.add_box(centred({0.0F, 0.9F}, {0.05F, 0.04F}, {0.0F, 0.03F}), {steel, steel});
  piece.add_box(centred({0.0F, 1.75F}, {0.2F, 0.2F}, {0.0F, 0.006F}), {sign, sign});
  piece.end_object();
}

void Furnisher::add_cabinet(const Place& place) {
  Piece piece = piece_at(place);
  const Colour coats[] = {paints::kGrey, 0.9F * paints::kWhite, 0.7F * paints::kBlue,
                          0.5F * paints::kGreen + 0.3F * paints::kGrey};
  const Colour coat = piece.draws().blend(coats);
  const Material body = piece.made_of(Finish::kPaint, coat);
  const Material steel = piece.made_of(Finish::kSteel, paints::kMetal);
  piece.begin_object("cabinet");
  piece.add_box(centred({0.0F, 0.6F}, {0.9F, 1.2F}, {0.0F, 0.30F}), {body, body});
  for (const float side : {-1.0F, 1.0F}) {
    const Material leaf = piece.made_of(Finish::kPaint, coat);
    const Material slots = piece.made_of(Finish::kGrille, coat);
    piece.add_box(centred({side * 0.222F, 0.62F}, {0.43F, 1.1F}, {0.30F, 0.315F}), {leaf, leaf});
    piece.add_box(centred({side * 0.05F, 0.7F}, {0.02F, 0.14F}, {0.315F, 0.335F}), {steel, steel});
    piece.add_box(centred({side * 0.222F, 0.18F}, {0.2F, 0.08F}, {0.315F, 0.317F}), {slots, leaf});
  }
  piece.begin_part(0);
  add_clutter(piece, {{-0.43F, 1.2F, 0.02F}, {0.43F, 1.52F, 0.28F}});
  piece.end_object();
  piece.add_paper(centred({0.22F, 0.95F}, {0.15F, 0.21F}, {0.315F, 0.316F}), kMinOwnSheet);
}

void Furnisher::add_switch(const Place& place) {
  Piece piece = piece_at(place);
  const Material plastic = piece.made_of(Finish::kPlastic, paints::kWhite);
  const Material hole = piece.made_of(Finish::kPlastic, paints::kBlack);
  const float top_m = place.wall.ceiling_m - place.wall.floor_m - 0.02F;
  piece.begin_object("switch");
  piece.add_box(centred({0.0F, 1.1F}, {0.085F, 0.085F}, {0.0F, 0.010F}), {plastic, plastic});
  piece.add_box(centred({0.0F, 1.1F}, {0.055F, 0.055F}, {0.010F, 0.014F}), {plastic, plastic});
  piece.add_box(centred({0.0F, 0.3F}, {0.085F, 0.085F}, {0.0F, 0.012F}), {plastic, plastic});
  piece.add_box(centred({0.0F, 0.3F}, {0.04F, 0.04F}, {0.012F, 0.013F}), {hole, hole});
  piece.add_box({{-0.011F, 1.143F, 0.0F}, {0.011F, top_m, 0.016F}}, {plastic, plastic});
  piece.end_object();
}

void Furnisher::add_notice(const Place& place) {
  constexpr float kHair_m = 0.001F;
  Piece piece = piece_at(place);
  const float up_m = piece.draws().blend(1.35F, 1.6F);
  const Material tape = piece.made_of(Finish::kPlastic, 0.9F * paints::kCork);
  piece.add_paper(centred({0.0F, up_m}, {0.21F, 0.297F}, {0.0F, kHair_m}), 0.3);
  piece.begin_object("tape");
  for (const float side : {-1.0F, 1.0F}) {
    piece.add_box(centred({0.08F * side, up_m + 0.148F}, {0.02F, 0.05F}, {kHair_m, 2.0F * kHair_m}),
                  {tape, tape});
  }
  piece.end_object();
}

void Furnisher::add_sign(const Place& place, Pictogram pictogram) {
  Piece piece = piece_at(place);
  const Colour grounds[] = {paints::kBlue, paints::kGrey, 0.8F * paints::kGreen, paints::kBlack};
  Material sign = piece.made_of(Finish::kSign, piece.draws().blend(grounds), paints::kWhite);
  sign.number = static_cast<int>(pictogram);
  piece.begin_object("sign");
  piece.add_box(centred({0.0F, 1.7F}, {0.22F, 0.22F}, {0.0F, 0.006F}), {sign, sign});
  piece.end_object();
}

void Furnisher::add_radiator(const Place& place) {
  constexpr float kHalf_m = 0.6F;
  constexpr int kNumRibs = 20;
  Piece piece = piece_at(place);
  const Material white = piece.made_of(Finish::kPaint, 0.95F * paints::kWhite);
  const Material top = piece.made_of(Finish::kGrille, 0.95F * paints::kWhite);
  const Material steel = piece.made_of(Finish::kSteel, paints::kMetal);
  piece.begin_object("radiator");
  piece.add_block({{-kHalf_m, 0.15F, 0.04F}, {kHalf_m, 0.68F, 0.10F}}, white);
  for (int i = 0; i < kNumRibs; ++i) {
    const float x_m = kHalf_m * (2.0F * (static_cast<float>(i) + 0.5F) / kNumRibs - 1.0F);
    piece.add_box(centred({x_m, 0.415F}, {0.032F, 0.49F}, {0.10F, 0.112F}), {white, white});
  }
  piece.add_panel({.corner_m = {-kHalf_m, 0.6805F, 0.10F},
                   .up = -Eigen::Vector3f::UnitZ(),
                   .size_m = {2.0F * kHalf_m, 0.06F}},
                  top);
  piece.add_bar({.from_m = {kHalf_m + 0.03F, 0.0F, 0.07F},
                 .to_m = {kHalf_m + 0.03F, 0.22F, 0.07F},
                 .radius_m = 0.011F,
                 .num_sides = 8},
                steel);
  piece.add_bar({.from_m = {kHalf_m, 0.2F, 0.07F},
                 .to_m = {kHalf_m + 0.1F, 0.2F, 0.07F},
                 .radius_m = 0.024F,
                 .num_sides = 8,
                 .has_ends = true},
                white);
  piece.end_object();
}

}  // namespace samewhere::twin
