#include <fmt/format.h>

#include <samewhere/twin/building/furnisher.hpp>
#include <samewhere/twin/building/piece.hpp>

namespace samewhere::twin {
namespace {

constexpr float kDoorHeight_m = 2.05F;
constexpr float kLeaf_m = 0.015F;  // stands out from the wall
const Colour kGlass = colour_of_srgb(0.20F, 0.25F, 0.28F);

// Lever, with a lock plate or a rose, or an upright bar; the lever points to the hinges, which are
// on the side of `to_hinges` (-1: left).
void add_handle(Piece& piece, Handle kind, float to_hinges, const Material& steel) {
  const float x_m = -0.38F * to_hinges;
  const Material hole = piece.made_of(Finish::kPlastic, paints::kBlack);
  if (kind == Handle::kBar) {
    piece.add_bar({.from_m = {x_m, 0.75F, 0.055F},
                   .to_m = {x_m, 1.35F, 0.055F},
                   .radius_m = 0.013F,
                   .num_sides = 8,
                   .has_ends = true},
                  steel);
    for (const float y_m : {0.8F, 1.3F}) {
      piece.add_box(centred({x_m, y_m}, {0.022F, 0.022F}, {kLeaf_m, 0.05F}), {steel, steel});
    }
    return;
  }
  const Eigen::Vector2f plate_m = kind == Handle::kLeverOnRose ? Eigen::Vector2f(0.055F, 0.055F)
                                                               : Eigen::Vector2f(0.045F, 0.21F);
  const float plate_up_m = kind == Handle::kLeverOnRose ? 1.06F : 1.02F;
  piece.add_box(centred({x_m, plate_up_m}, plate_m, {kLeaf_m, 0.022F}), {steel, steel});
  piece.add_box(centred({x_m, 1.06F}, {0.022F, 0.022F}, {0.022F, 0.055F}), {steel, steel});
  piece.add_bar({.from_m = {x_m - 0.012F * to_hinges, 1.06F, 0.062F},
                 .to_m = {x_m + 0.12F * to_hinges, 1.06F, 0.062F},
                 .radius_m = 0.010F,
                 .num_sides = 8,
                 .has_ends = true},
                steel);
  piece.add_box(centred({x_m, 0.96F}, {0.012F, 0.024F}, {kLeaf_m, 0.0235F}), {hole, hole});
}

// A box with an arm at the top of a leaf, or none.
void add_closer(Piece& piece, Closer kind, float to_hinges, const Material& steel) {
  const bool is_at_hinges = kind == Closer::kAtHinges;
  if (kind == Closer::kNone) return;
  const float x_m = is_at_hinges ? 0.25F * to_hinges : 0.0F;
  const Eigen::Vector2f size_m =
      is_at_hinges ? Eigen::Vector2f(0.26F, 0.06F) : Eigen::Vector2f(0.48F, 0.035F);
  piece.add_box(centred({x_m, 1.98F}, size_m, {kLeaf_m, 0.065F}), {steel, steel});
}

void add_hinges(Piece& piece, float x_m, const Material& steel) {
  for (const float y_m : {0.25F, 1.0F, 1.8F}) {
    piece.add_bar({.from_m = {x_m, y_m - 0.05F, 0.026F},
                   .to_m = {x_m, y_m + 0.05F, 0.026F},
                   .radius_m = 0.011F,
                   .num_sides = 8},
                  steel);
  }
}

void add_pane(Piece& piece, const Box& pane, const Material& steel) {
  const Material glass = piece.made_of(Finish::kPlastic, kGlass);
  piece.add_box(pane, {glass, glass});
  Box around = pane;
  around.high_m.z() += 0.008F;
  piece.add_frame(around, 0.025F, steel);
}

void add_leaf_extras(Piece& piece, int variant, float to_hinges, const Material& steel) {
  if (variant == 1 || variant == 3) {
    piece.add_box(centred({0.0F, 0.14F}, {0.84F, 0.24F}, {kLeaf_m, 0.017F}), {steel, steel});
  }
  if (variant == 2 || variant == 3) {
    add_pane(piece, centred({-0.18F * to_hinges, 1.55F}, {0.16F, 0.6F}, {kLeaf_m, 0.017F}), steel);
  }
  if (variant == 4) {
    add_pane(piece, centred({0.05F * to_hinges, 1.45F}, {0.5F, 0.7F}, {kLeaf_m, 0.017F}), steel);
  }
}

void add_plate(Piece& piece, int number) {
  Material plate =
      piece.made_of(Finish::kPlate, paints::kWhite, colour_of_srgb(0.10F, 0.15F, 0.35F));
  plate.number = number;
  const Material edge = piece.made_of(Finish::kSteel, paints::kMetal);
  const float up_m = piece.palette().door.plate_m;
  piece.begin_object(fmt::format("door plate {}", number), true);
  piece.add_box(centred({0.68F, up_m}, {0.17F, 0.15F}, {0.0F, 0.008F}), {plate, edge});
  piece.end_object();
}

}  // namespace

void Furnisher::add_door(const Place& place, int number) {
  constexpr float kWidth_m = 0.90F;
  constexpr int kNumVariants = 5;
  const DoorDesign& design = palette_.door;
  const float to_hinges = design.is_mirrored ? 1.0F : -1.0F;
  Piece piece = piece_at(place);
  const Material wood = piece.made_of(Finish::kWood, palette_.wood);
  const Material paint = piece.made_of(Finish::kPaint, palette_.frame);
  const Material steel = piece.made_of(Finish::kSteel, paints::kMetal);
  piece.begin_object("door");
  Box leaf = centred({0.0F, 0.5F * kDoorHeight_m}, {kWidth_m, kDoorHeight_m}, {0.0F, kLeaf_m});
  leaf.low_m.y() = 0.0F;
  piece.add_box(leaf, {wood, wood});
  leaf.high_m.z() = 0.04F;
  piece.add_frame(leaf, design.frame_m, paint);
  add_handle(piece, design.handle, to_hinges, steel);
  add_hinges(piece, 0.442F * to_hinges, steel);
  add_closer(piece, design.closer, to_hinges, steel);
  piece.begin_part(1);
  add_leaf_extras(piece, piece.draws().pick(kNumVariants), to_hinges, steel);
  piece.end_object();
  piece.begin_part(0);
  if (number > 0) add_plate(piece, number);
}

void Furnisher::add_double_door(const Place& place) {
  constexpr float kHalf_m = 0.9F;
  Piece piece = piece_at(place);
  const Material paint = piece.made_of(Finish::kPaint, palette_.frame);
  const Material steel = piece.made_of(Finish::kSteel, paints::kMetal);
  const bool has_panes = piece.draws().happens(0.7);
  piece.begin_object("double door");
  for (const float side : {-1.0F, 1.0F}) {
    piece.begin_part(static_cast<int>(side) + 1);
    const Material wood = piece.made_of(Finish::kWood, palette_.wood);
    const float middle_m = side * (0.5F * kHalf_m + 0.002F);
    piece.add_box(centred({middle_m, 0.5F * kDoorHeight_m}, {kHalf_m - 0.004F, kDoorHeight_m},
                          {0.0F, kLeaf_m}),
                  {wood, wood});
    const Box pane = centred({middle_m, 1.4F}, {0.42F, 0.9F}, {kLeaf_m, 0.017F});
    if (has_panes) add_pane(piece, pane, steel);
    // a push bar on two feet
    piece.add_bar({.from_m = {middle_m - 0.33F, 0.9F, 0.07F},
                   .to_m = {middle_m + 0.33F, 0.9F, 0.07F},
                   .radius_m = 0.016F,
                   .num_sides = 8,
                   .has_ends = true},
                  steel);
    for (const float foot : {-0.3F, 0.3F}) {
      piece.add_box(centred({middle_m + foot, 0.9F}, {0.05F, 0.09F}, {kLeaf_m, 0.06F}),
                    {steel, steel});
    }
    add_hinges(piece, side * (kHalf_m + 0.008F), steel);
  }
  Box around =
      centred({0.0F, 0.5F * kDoorHeight_m}, {2.0F * kHalf_m, kDoorHeight_m}, {0.0F, 0.04F});
  around.low_m.y() = 0.0F;
  piece.add_frame(around, 0.07F, paint);
  piece.end_object();
}

void Furnisher::add_lift_door(const Place& place, int floor) {
  constexpr float kHalf_m = 0.45F;
  constexpr float kHeight_m = 2.1F;
  Piece piece = piece_at(place);
  const Material steel = piece.made_of(Finish::kSteel, paints::kMetal);
  const Material frame = piece.made_of(Finish::kSteel, 0.8F * paints::kMetal);
  const Material black = piece.made_of(Finish::kPlastic, paints::kBlack);
  piece.begin_object("lift door");
  for (const float side : {-1.0F, 1.0F}) {
    const Material leaf = piece.made_of(Finish::kSteel, 0.9F * paints::kMetal);
    piece.add_box(centred({side * (0.5F * kHalf_m + 0.002F), 0.5F * kHeight_m},
                          {kHalf_m - 0.004F, kHeight_m}, {0.0F, 0.012F}),
                  {leaf, leaf});
  }
  Box around = centred({0.0F, 0.5F * kHeight_m}, {2.0F * kHalf_m, kHeight_m}, {0.0F, 0.05F});
  around.low_m.y() = 0.0F;
  piece.add_frame(around, 0.12F, frame);
  piece.add_box(centred({0.75F, 1.1F}, {0.09F, 0.26F}, {0.0F, 0.01F}), {steel, steel});
  for (const float y_m : {1.06F, 1.14F}) {
    piece.add_bar({.from_m = {0.75F, y_m, 0.01F},
                   .to_m = {0.75F, y_m, 0.018F},
                   .radius_m = 0.016F,
                   .num_sides = 8,
                   .has_ends = true},
                  black);
  }
  // the car's place, in a window over the door
  Material display = piece.made_of(Finish::kBigNumber, paints::kBlack, paints::kOrange);
  display.number = floor;
  piece.add_box(centred({0.0F, 2.3F}, {0.24F, 0.11F}, {0.0F, 0.01F}), {display, black});
  piece.end_object();
}

void Furnisher::add_floor_number(const Place& place, int floor) {
  add_number(place, fmt::format("floor number {}", floor), floor,
             centred({0.0F, 1.65F}, {0.36F, 0.42F}, {0.0F, 0.006F}));
}

void Furnisher::add_bay_number(const Place& place, int bay) {
  add_number(place, fmt::format("bay number {}", bay), bay,
             centred({0.0F, 2.75F}, {0.60F, 0.70F}, {0.0F, 0.006F}));
}

void Furnisher::add_number(const Place& place, const std::string& name, int number,
                           const Box& board) {
  Piece piece = piece_at(place);
  const Colour inks[] = {paints::kBlue, paints::kGreen, paints::kGrey, paints::kRed};
  Material sign =
      piece.made_of(Finish::kBigNumber, paints::kWhite, 0.7F * piece.draws().blend(inks));
  sign.number = number;
  piece.begin_object(name, true);
  piece.add_box(board, {sign, sign});
  piece.end_object();
}

void Furnisher::add_window(const Place& place, Daylight daylight) {
  Piece piece = piece_at(place);
  const Material white = piece.made_of(Finish::kPlastic, paints::kWhite);
  const Material stone = piece.made_of(Finish::kConcrete, paints::kWhite);
  const bool is_open = daylight == Daylight::kView;
  const WindowDesign& design = palette_.window;
  Material pane = piece.made_of(is_open ? Finish::kView : Finish::kBlinds, paints::kDaylight);
  constexpr float kSky = 1.4F;
  constexpr float kBlinds = 1.3F;
  pane.radiance = piece.light().daylight * (is_open ? kSky : kBlinds);
  pane.number = design.dressing;
  piece.begin_object("window");
  constexpr float kBottom_m = 0.95F;
  const float middle_m = kBottom_m + 0.5F * design.pane_m.y();
  const Box glass = centred({0.0F, middle_m}, design.pane_m, {0.0F, 0.004F});
  piece.add_box(glass, {pane, white});
  Box around = glass;
  around.high_m.z() = 0.05F;
  piece.add_frame(around, 0.06F, white);
  const int num_bars = is_open ? 1 : design.num_bars;
  for (int i = 0; i < num_bars; ++i) {
    const auto ratio = (static_cast<float>(i) + 1.0F) / static_cast<float>(num_bars + 1);
    const float x_m = (ratio - 0.5F) * design.pane_m.x();
    piece.add_box(centred({x_m, middle_m}, {0.07F, design.pane_m.y()}, {0.0F, 0.045F}),
                  {white, white});
  }
  if (is_open) {
    const Material steel = piece.made_of(Finish::kSteel, paints::kMetal);
    piece.add_box(centred({0.0F, 1.5F}, {0.025F, 0.14F}, {0.045F, 0.075F}), {steel, steel});
  }
  if (design.has_sill) {
    piece.add_box(centred({0.0F, 0.87F}, {design.pane_m.x() + 0.2F, 0.03F}, {0.0F, 0.15F}),
                  {stone, stone});
  }
  piece.end_object();
}

}  // namespace samewhere::twin
