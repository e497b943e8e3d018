#include <algorithm>

#include <samewhere/twin/building/furnisher.hpp>
#include <samewhere/twin/building/piece.hpp>

namespace samewhere::twin {
namespace {

constexpr float kPallet_m = 0.144F;  // its height

// 1.2 m x 0.8 m, the long side along x, its middle at `at_m`.
void add_pallet_boards(Piece& piece, const Eigen::Vector3f& at_m) {
  const Material wood = piece.made_of(Finish::kWood, paints::kPalletWood);
  const auto add = [&](const Eigen::Vector3f& low_m, const Eigen::Vector3f& high_m) {
    piece.add_block({at_m + low_m, at_m + high_m}, wood);
  };
  for (const float x_m : {-0.5275F, 0.0F, 0.5275F}) {
    add({x_m - 0.0725F, 0.022F, -0.4F}, {x_m + 0.0725F, 0.1F, 0.4F});
  }
  for (const float z_m : {-0.34F, 0.0F, 0.34F}) {
    add({-0.6F, 0.0F, z_m - 0.06F}, {0.6F, 0.022F, z_m + 0.06F});
  }
  for (const float z_m : {-0.33F, -0.165F, 0.0F, 0.165F, 0.33F}) {
    add({-0.6F, 0.122F, z_m - 0.06F}, {0.6F, kPallet_m, z_m + 0.06F});
  }
  add({-0.6F, 0.1F, -0.4F}, {0.6F, 0.122F, 0.4F});
}

// A label on the front of a carton and one on its back.
void add_labels(Piece& piece, const Box& carton, const Material& label) {
  constexpr float kHair_m = 1e-3F;
  const Eigen::Vector2f size_m(0.14F, 0.1F);
  const float x_m = piece.draws().blend(0.02F, 0.12F);
  const float y_m = piece.draws().blend(0.03F, 0.1F);
  const Eigen::Vector3f front_m(carton.low_m.x() + x_m, carton.low_m.y() + y_m,
                                carton.high_m.z() + kHair_m);
  piece.add_panel({.corner_m = front_m, .size_m = size_m}, label);
  const Eigen::Vector3f back_m(carton.high_m.x() - x_m, carton.low_m.y() + y_m,
                               carton.low_m.z() - kHair_m);
  piece.add_panel({.corner_m = back_m, .right = -Eigen::Vector3f::UnitX(), .size_m = size_m},
                  label);
}

// Two or three layers of cartons on a pallet, six to a layer.
void add_cartons(Piece& piece, const Eigen::Vector3f& at_m, float room_m) {
  constexpr int kNumColumns = 3;
  constexpr int kNumRows = 2;
  constexpr float kGap_m = 0.006F;
  Draws& draws = piece.draws();
  const Colour tints[] = {paints::kCarton, 1.15F * paints::kCarton, 0.85F * paints::kCarton,
                          0.8F * paints::kWhite};
  const Colour tint = draws.blend(tints);
  const float height_m = draws.blend(0.24F, 0.42F);
  const int most = std::max(1, static_cast<int>(room_m / height_m));
  const int num_layers = std::min(most, 1 + draws.pick(3));
  const float width_m = 1.16F / kNumColumns;
  const float depth_m = 0.76F / kNumRows;
  for (int i = 0; i < num_layers * kNumColumns * kNumRows; ++i) {
    const auto column = static_cast<float>(i % kNumColumns);
    const auto row = static_cast<float>((i / kNumColumns) % kNumRows);
    const int layer_index = i / (kNumColumns * kNumRows);
    const auto layer = static_cast<float>(layer_index);
    const Material carton = piece.made_of(Finish::kCarton, draws.blend(0.9F, 1.1F) * tint);
    const Material label = piece.made_of(Finish::kLabel, paints::kWhite, paints::kBlack);
    const float jitter_m = draws.shift(0.01F);
    const bool is_gone = layer + 1.0F >= static_cast<float>(num_layers) && !draws.happens(0.75);
    const Eigen::Vector3f low_m =
        at_m + Eigen::Vector3f(-0.58F + width_m * column + kGap_m,
                               kPallet_m + (height_m + 1e-3F) * layer + 1e-3F,
                               -0.38F + depth_m * row + kGap_m + jitter_m);
    const Box box{
        low_m, low_m + Eigen::Vector3f(width_m - 2.0F * kGap_m, height_m, depth_m - 2.0F * kGap_m)};
    if (is_gone) continue;
    piece.add_block(box, carton);
    add_labels(piece, box, label);
  }
}

// Cartons or drums on a pallet, or nothing at all.
void add_load(Piece& piece, const Eigen::Vector3f& at_m, float room_m) {
  const int kind = piece.draws().pick(6);
  if (kind == 0) return;
  add_pallet_boards(piece, at_m);
  if (kind > 1) return add_cartons(piece, at_m, room_m);
  const Colour drums[] = {paints::kBlue, paints::kGreen, paints::kGrey, paints::kRed};
  for (const float x_m : {-0.29F, 0.29F}) {
    const Material drum = piece.made_of(Finish::kPaint, piece.draws().blend(drums));
    const float top_m = kPallet_m + std::min(0.88F, room_m);
    const Eigen::Vector3f middle_m = at_m + Eigen::Vector3f(x_m, 0.0F, 0.0F);
    piece.add_bar({.from_m = middle_m + Eigen::Vector3f(0.0F, kPallet_m, 0.0F),
                   .to_m = middle_m + Eigen::Vector3f(0.0F, top_m, 0.0F),
                   .radius_m = 0.285F,
                   .num_sides = 12,
                   .has_ends = true},
                  drum);
  }
}

constexpr float kHalfRack_m = 0.55F;
constexpr float kLevel_m = 1.5F;

// Where the bays of a rack are along it.
struct Bays {
  explicit Bays(const RackSize& size)
      : count(std::max(1, static_cast<int>(size.length_m / 1.4F))),
        width_m(size.length_m / static_cast<float>(count)),
        left_m(-0.5F * size.length_m),
        right_m(0.5F * size.length_m) {}

  float edge_m(int i) const { return left_m + width_m * static_cast<float>(i); }
  float middle_m(int i) const { return edge_m(i) + 0.5F * width_m; }

  int count;
  float width_m;
  float left_m;
  float right_m;
};

// Two posts at one place along the rack with braces between them.
void add_uprights(Piece& piece, float x_m, float top_m, const Material& paint) {
  for (const float z_m : {-kHalfRack_m, kHalfRack_m}) {
    piece.add_block({{x_m - 0.045F, 0.0F, z_m - 0.035F}, {x_m + 0.045F, top_m, z_m + 0.035F}},
                    paint);
  }
  for (float y_m = 0.2F; y_m + 0.8F < top_m; y_m += 0.8F) {
    piece.add_bar({.from_m = {x_m, y_m, -kHalfRack_m},
                   .to_m = {x_m, y_m + 0.7F, kHalfRack_m},
                   .radius_m = 0.018F,
                   .num_sides = 6},
                  paint);
  }
}

// Along the front (side 1) or the back (-1) of a level, with a tag for each bay.
void add_beam(Piece& piece, const Bays& bays, float y_m, float side) {
  const Material paint = piece.made_of(Finish::kPaint, paints::kOrange);
  const float z_m = side * kHalfRack_m;
  piece.add_block({{bays.left_m, y_m - 0.1F, z_m - 0.025F}, {bays.right_m, y_m, z_m + 0.025F}},
                  paint);
  for (int i = 0; i < bays.count; ++i) {
    const Material tag = piece.made_of(Finish::kLabel, paints::kWhite, paints::kBlack);
    piece.add_panel(
        {.corner_m = {bays.middle_m(i) - side * 0.05F, y_m - 0.085F, z_m + side * 0.026F},
         .right = side * Eigen::Vector3f::UnitX(),
         .size_m = {0.1F, 0.07F}},
        tag);
  }
}

}  // namespace

void Furnisher::add_pallet(const Spot& spot) {
  Piece piece = piece_at(spot);
  piece.begin_object("pallet");
  add_pallet_boards(piece, Eigen::Vector3f::Zero());
  add_cartons(piece, Eigen::Vector3f::Zero(), 1.2F);
  piece.end_object();
}

void Furnisher::add_rack(const Spot& spot, const RackSize& size) {
  Piece piece = piece_at(spot);
  const Colour coats[] = {paints::kBlue, paints::kGrey, 0.6F * paints::kGreen};
  const Material paint = piece.made_of(Finish::kPaint, piece.draws().blend(coats));
  const Bays bays(size);
  const float top_m = kLevel_m * static_cast<float>(size.num_levels - 1) + 0.5F;
  piece.begin_object("rack");
  for (int i = 0; i <= bays.count; ++i) add_uprights(piece, bays.edge_m(i), top_m, paint);
  for (int level = 0; level < size.num_levels; ++level) {
    const float y_m = kLevel_m * static_cast<float>(level);
    piece.begin_part(1000 + level);
    if (level > 0) {  // the lowest stands on the floor
      for (const float side : {-1.0F, 1.0F}) add_beam(piece, bays, y_m, side);
    }
    for (int i = 0; i < bays.count; ++i) {
      piece.begin_part(level * bays.count + i);
      const float shift_m = piece.draws().shift(0.04F);
      add_load(piece, {bays.middle_m(i) + shift_m, y_m, 0.0F}, kLevel_m - kPallet_m - 0.2F);
    }
  }
  piece.end_object();
}

}  // namespace samewhere::twin
