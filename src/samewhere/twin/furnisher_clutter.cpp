#include <algorithm>
#include <array>

#include <samewhere/twin/clutter.hpp>
#include <samewhere/twin/furnisher.hpp>
#include <samewhere/twin/noise.hpp>

namespace samewhere::twin {
namespace {

Colour vivid(Piece& piece) {
  static const std::array<Colour, 9> dyes = {
      colour_of_srgb(0.80F, 0.16F, 0.14F), colour_of_srgb(0.12F, 0.34F, 0.66F),
      colour_of_srgb(0.92F, 0.72F, 0.12F), colour_of_srgb(0.10F, 0.46F, 0.26F),
      colour_of_srgb(0.88F, 0.45F, 0.12F), colour_of_srgb(0.45F, 0.18F, 0.44F),
      colour_of_srgb(0.10F, 0.10F, 0.12F), colour_of_srgb(0.93F, 0.92F, 0.88F),
      colour_of_srgb(0.16F, 0.56F, 0.60F)};
  return piece.draws().blend(dyes);
}

// A packet or a file that stands, print on its front.
void add_packet(Piece& piece, const Box& room) {
  Draws& draws = piece.draws();
  Box box = room;
  box.high_m.y() = lerp(room.low_m.y() + 0.1F, room.high_m.y(), draws.blend(0.2F, 1.0F));
  box.low_m.z() = lerp(room.low_m.z(), room.high_m.z(), draws.blend(0.0F, 0.6F));
  box.high_m.z() = std::min(room.high_m.z(), box.low_m.z() + draws.blend(0.04F, 0.14F));
  Material print = piece.made_of(Finish::kPaper, vivid(piece), vivid(piece));
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
    const Material cover = piece.made_of(Finish::kPlastic, vivid(piece));
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
                 piece.made_of(Finish::kPlastic, vivid(piece)));
}

// A coat on its hook: narrow below the collar, wider from the shoulders on.
void add_coat(Piece& piece, float x_m, float hook_m) {
  constexpr float kShoulder_m = 0.12F;
  Draws& draws = piece.draws();
  const float long_m = draws.blend(0.55F, 0.95F);
  const float radius_m = draws.blend(0.08F, 0.105F);
  Material cloth = piece.made_of(Finish::kFabric, vivid(piece), vivid(piece));
  cloth.number = draws.pick(3);
  const Eigen::Vector3f hook(x_m, hook_m, 0.015F + radius_m);
  const Eigen::Vector3f down = -Eigen::Vector3f::UnitY();
  piece.add_bar({.from_m = hook + long_m * down,
                 .to_m = hook + kShoulder_m * down,
                 .radius_m = radius_m,
                 .num_sides = 12,
                 .has_ends = true},
                cloth);
  piece.add_bar({.from_m = hook + kShoulder_m * down,
                 .to_m = hook + 0.03F * down,
                 .radius_m = 0.055F,
                 .num_sides = 10,
                 .has_ends = true},
                cloth);
}

void add_bag(Piece& piece, float x_m, float hook_m) {
  Draws& draws = piece.draws();
  const float top_m = hook_m - draws.blend(0.2F, 0.4F);
  const float high_m = draws.blend(0.26F, 0.4F);
  const float deep_m = draws.blend(0.1F, 0.16F);
  const Colour dye = vivid(piece);
  const Material cloth = piece.made_of(Finish::kFabric, dye, 0.7F * dye);
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
    Material print = piece.made_of(Finish::kPaper, vivid(piece), vivid(piece));
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
    const Material body = piece.made_of(Finish::kPlastic, vivid(piece));
    const Material label = piece.made_of(Finish::kLabel, paints::kWhite, vivid(piece));
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
