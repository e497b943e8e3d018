#include <algorithm>
#include <array>

#include <samewhere/twin/building/clutter.hpp>
#include <samewhere/twin/building/furnisher.hpp>
#include <samewhere/twin/building/noise.hpp>

namespace samewhere::twin {
namespace {

// Of print, cloth and moulded things: half of them muted.
Colour dye(Piece& piece) {
  static const std::array<Colour, 10> dyes = {
      colour_of_srgb(0.72F, 0.20F, 0.17F), colour_of_srgb(0.18F, 0.35F, 0.58F),
      colour_of_srgb(0.84F, 0.69F, 0.30F), colour_of_srgb(0.30F, 0.42F, 0.34F),
      colour_of_srgb(0.66F, 0.50F, 0.34F), colour_of_srgb(0.38F, 0.30F, 0.38F),
      colour_of_srgb(0.14F, 0.14F, 0.16F), colour_of_srgb(0.90F, 0.89F, 0.85F),
      colour_of_srgb(0.32F, 0.48F, 0.50F), colour_of_srgb(0.56F, 0.55F, 0.53F)};
  return piece.draws().blend(dyes);
}

// A packet or a file that stands, print on its front.
void add_packet(Piece& piece, const Box& room) {
  Draws& draws = piece.draws();
  Box box = room;
  box.high_m.y() = lerp(room.low_m.y() + 0.1F, room.high_m.y(), draws.blend(0.2F, 1.0F));
  box.low_m.z() = lerp(room.low_m.z(), room.high_m.z(), draws.blend(0.0F, 0.6F));
  box.high_m.z() = std::min(room.high_m.z(), box.low_m.z() + draws.blend(0.04F, 0.14F));
  Material print = piece.made_of(Finish::kPaper, dye(piece), dye(piece));
  print.gloss = 0.5F;
  piece.add_block(box, print);
}

// Up to four books on each other, none above the other's edge.
void add_pile(Piece& piece, const Box& room) {
  constexpr int kMost = 4;
  Draws& draws = piece.draws();
  const int num_books = 1 + draws.pick(kMost);
  float y_m = room.low_m.y();
  for (int i = 0; i < kMost; ++i) {
    const float thick_m = draws.blend(0.015F, 0.045F);
    const float inset_m = 0.004F * static_cast<float>(i) + draws.blend(0.0F, 0.012F);
    const float back_m = draws.blend(0.0F, 0.3F) * (room.high_m.z() - room.low_m.z());
    const Material cover = piece.made_of(Finish::kPlastic, dye(piece));
    if (i >= num_books || y_m + thick_m > room.high_m.y()) continue;
    piece.add_block({{room.low_m.x() + inset_m, y_m, room.low_m.z() + back_m},
                     {room.high_m.x() - inset_m, y_m + thick_m, room.high_m.z() - inset_m}},
                    cover);
    y_m += thick_m;
  }
}

// A bottle, a cup or a jar.
void add_vessel(Piece& piece, const Box& room) {
  Draws& draws = piece.draws();
  const Eigen::Vector3f size_m = room.high_m - room.low_m;
  const float radius_m =
      draws.blend(0.6F, 1.0F) * std::min({0.5F * size_m.x(), 0.05F, 0.5F * size_m.z()});
  const float height_m = std::min(draws.blend(0.09F, 0.28F), size_m.y());
  const Eigen::Vector2f middle_m(
      0.5F * (room.low_m.x() + room.high_m.x()),
      lerp(room.low_m.z() + radius_m, room.high_m.z() - radius_m, draws.blend(0.0F, 1.0F)));
  piece.add_post({.low_m = room.low_m.y(),
                  .high_m = room.low_m.y() + height_m,
                  .middle_m = middle_m,
                  .half_m = Eigen::Vector2f::Constant(radius_m),
                  .num_sides = 10,
                  .has_lid = true},
                 piece.made_of(Finish::kPlastic, dye(piece)));
}

// A coat on its hook: flat, wider from the collar to the shoulders and again towards the hem, its
// sleeves hanging down in front.
void add_coat(Piece& piece, float x_m, float hook_m) {
  struct Section {
    float from, to;  // shares of the length below the hook
    float half_m;
  };
  constexpr std::array<Section, 5> kSections = {{{0.03F, 0.07F, 0.04F},
                                                 {0.07F, 0.11F, 0.08F},
                                                 {0.11F, 0.45F, 0.105F},
                                                 {0.45F, 0.75F, 0.112F},
                                                 {0.75F, 1.0F, 0.12F}}};
  Draws& draws = piece.draws();
  const float long_m = draws.blend(0.75F, 1.1F);
  const float deep_m = draws.blend(0.045F, 0.06F);
  Material cloth = piece.made_of(Finish::kFabric, dye(piece), dye(piece));
  cloth.number = std::max(0, draws.pick(6) - 3);  // most are plain
  for (const Section& section : kSections) {
    piece.add_post({.low_m = hook_m - section.to * long_m,
                    .high_m = hook_m - section.from * long_m,
                    .middle_m = {x_m, 0.015F + deep_m},
                    .half_m = {section.half_m, deep_m * std::min(1.0F, section.half_m / 0.08F)},
                    .num_sides = 12,
                    .has_lid = true},
                   cloth);
  }
  for (const float side : {-1.0F, 1.0F}) {
    piece.add_bar({.from_m = {x_m + 0.088F * side, hook_m - 0.72F * long_m, 0.03F + 1.6F * deep_m},
                   .to_m = {x_m + 0.080F * side, hook_m - 0.13F * long_m, 0.015F + 1.1F * deep_m},
                   .radius_m = 0.034F,
                   .num_sides = 10,
                   .has_ends = true},
                  cloth);
  }
}

void add_bag(Piece& piece, float x_m, float hook_m) {
  Draws& draws = piece.draws();
  const float top_m = hook_m - draws.blend(0.2F, 0.4F);
  const float high_m = draws.blend(0.26F, 0.4F);
  const float deep_m = draws.blend(0.1F, 0.16F);
  const Colour colour = dye(piece);
  const Material cloth = piece.made_of(Finish::kFabric, colour, 0.7F * colour);
  piece.add_block({{x_m - 0.115F, top_m - high_m, 0.012F}, {x_m + 0.115F, top_m, deep_m}}, cloth);
  piece.add_block({{x_m - 0.085F, top_m - 0.8F * high_m, deep_m},
                   {x_m + 0.085F, top_m - 0.35F * high_m, deep_m + 0.035F}},
                  cloth);
  for (const float side : {-1.0F, 1.0F}) {
    piece.add_bar({.from_m = {x_m + 0.09F * side, top_m, 0.05F},
                   .to_m = {x_m, hook_m, 0.04F},
                   .radius_m = 0.008F,
                   .num_sides = 6},
                  cloth);
  }
}

}  // namespace

void add_clutter(Piece& piece, const Box& room) {
  constexpr float kPitch_m = 0.13F;
  constexpr float kGap_m = 0.012F;
  constexpr int kNumKinds = 4;  // one of them: nothing
  const auto num_columns = static_cast<int>((room.high_m.x() - room.low_m.x() + kGap_m) / kPitch_m);
  for (int i = 0; i < num_columns; ++i) {
    Box column = room;
    column.low_m.x() = room.low_m.x() + kPitch_m * static_cast<float>(i);
    column.high_m.x() = column.low_m.x() + kPitch_m - kGap_m;
    switch (piece.draws().pick(kNumKinds)) {
      case 0:
        add_packet(piece, column);
        break;
      case 1:
        add_pile(piece, column);
        break;
      case 2:
        add_vessel(piece, column);
        break;
      default:
        break;
    }
  }
}

void Furnisher::add_coat_rack(const Place& place) {
  constexpr float kHook_m = 1.68F;
  constexpr int kNumHooks = 4;
  Piece piece = piece_at(place);
  const Material wood = piece.made_of(Finish::kWood, palette_.wood);
  const Material steel = piece.made_of(Finish::kSteel, paints::kMetal);
  piece.begin_object("coat rack");
  piece.add_box({{-0.5F, kHook_m - 0.03F, 0.0F}, {0.5F, kHook_m + 0.09F, 0.018F}}, {wood, wood});
  for (int i = 0; i < kNumHooks; ++i) {
    piece.begin_part(i);
    const float x_m = 0.25F * (static_cast<float>(i) - 1.5F);
    piece.add_bar({.from_m = {x_m, kHook_m + 0.03F, 0.018F},
                   .to_m = {x_m, kHook_m + 0.05F, 0.08F},
                   .radius_m = 0.008F,
                   .num_sides = 6,
                   .has_ends = true},
                  steel);
    const float what = piece.draws().shift(1.0F);
    if (what < 0.0F) add_coat(piece, x_m, kHook_m);
    if (what > 0.3F) add_bag(piece, x_m, kHook_m);
  }
  piece.end_object();
}

void Furnisher::add_leaflets(const Place& place) {
  constexpr int kNumColumns = 5;
  constexpr int kNumRows = 3;
  Piece piece = piece_at(place);
  const Material steel = piece.made_of(Finish::kPaint, paints::kGrey);
  piece.begin_object("leaflets");
  piece.add_box({{-0.36F, 0.62F, 0.0F}, {0.36F, 1.54F, 0.008F}}, {steel, steel});
  for (int i = 0; i < kNumColumns * kNumRows; ++i) {
    piece.begin_part(i);
    Draws& draws = piece.draws();
    const float x_m = 0.14F * (static_cast<float>(i % kNumColumns) - 2.0F);
    const int row = i / kNumColumns;
    const float y_m = 0.66F + 0.3F * static_cast<float>(row);
    const float out_m = draws.blend(0.016F, 0.04F);
    const float high_m = draws.blend(0.19F, 0.25F);
    Material print = piece.made_of(Finish::kPaper, dye(piece), dye(piece));
    print.gloss = 0.5F;
    piece.add_box({{x_m - 0.068F, y_m - 0.02F, 0.008F}, {x_m + 0.068F, y_m, 0.048F}},
                  {steel, steel});
    if (draws.happens(0.85)) {
      piece.add_box({{x_m - 0.052F, y_m, 0.008F}, {x_m + 0.052F, y_m + high_m, out_m}},
                    {print, print});
    }
  }
  piece.end_object();
}

void Furnisher::add_low_shelf(const Place& place) {
  constexpr float kHalf_m = 0.42F;
  constexpr float kDeep_m = 0.3F;
  constexpr float kPitch_m = 0.36F;
  constexpr int kNumBoards = 3;
  constexpr float kBoard_m = 0.02F;
  constexpr float kAbove_m = 0.32F;
  Piece piece = piece_at(place);
  const Colour coats[] = {palette_.wood, 0.9F * paints::kWhite, 0.8F * paints::kBlue};
  const Material board = piece.made_of(Finish::kWood, piece.draws().blend(coats));
  piece.begin_object("low shelf");
  const float height_m = kPitch_m * static_cast<float>(kNumBoards - 1) + 0.08F;
  for (const float side : {-1.0F, 1.0F}) {
    const float x_m = side * (kHalf_m + 0.01F);
    piece.add_block({{x_m - 0.01F, 0.0F, 0.002F}, {x_m + 0.01F, height_m, kDeep_m}}, board);
  }
  for (int i = 0; i < kNumBoards; ++i) {
    piece.begin_part(i);
    const float y_m = 0.06F + kPitch_m * static_cast<float>(i);
    piece.add_block({{-kHalf_m, y_m, 0.004F}, {kHalf_m, y_m + kBoard_m, kDeep_m - 0.005F}}, board);
    add_clutter(piece, {{-kHalf_m + 0.03F, y_m + kBoard_m, 0.02F},
                        {kHalf_m - 0.01F, y_m + kBoard_m + kAbove_m, kDeep_m - 0.03F}});
  }
  piece.end_object();
}

void Furnisher::add_crates(const Place& place) {
  constexpr int kMost = 4;
  constexpr float kHigh_m = 0.22F;
  Piece piece = piece_at(place);
  const int num_crates = 2 + piece.draws().pick(kMost - 1);
  piece.begin_object("crates");
  for (int i = 0; i < kMost; ++i) {
    piece.begin_part(i);
    const float x_m = piece.draws().blend(-0.03F, 0.03F);
    const float out_m = piece.draws().blend(0.02F, 0.06F);
    const float y_m = kHigh_m * static_cast<float>(i);
    const Material body = piece.made_of(Finish::kPlastic, dye(piece));
    const Material label = piece.made_of(Finish::kLabel, paints::kWhite, dye(piece));
    const Box box{{x_m - 0.2F, y_m, out_m}, {x_m + 0.2F, y_m + kHigh_m - 0.012F, out_m + 0.3F}};
    if (i < num_crates) {
      piece.add_block(box, body);
      piece.add_block({{x_m - 0.21F, y_m + kHigh_m - 0.06F, out_m - 0.01F},
                       {x_m + 0.21F, y_m + kHigh_m - 0.03F, out_m + 0.31F}},
                      body);
      piece.add_panel(
          {.corner_m = {x_m - 0.08F, y_m + 0.04F, out_m + 0.301F}, .size_m = {0.14F, 0.09F}},
          label);
    }
    if (i + 1 == num_crates) {
      add_clutter(piece, {{x_m - 0.18F, y_m + kHigh_m - 0.012F, out_m + 0.03F},
                          {x_m + 0.2F, y_m + kHigh_m + 0.26F, out_m + 0.27F}});
    }
  }
  piece.end_object();
}

}  // namespace samewhere::twin
