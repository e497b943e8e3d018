#include <cmath>

#include <samewhere/twin/building/clutter.hpp>
#include <samewhere/twin/building/furnisher.hpp>
#include <samewhere/twin/building/piece.hpp>

namespace samewhere::twin {
namespace {

// A round leg between two points.
void add_leg(Piece& piece, const Eigen::Vector3f& foot_m, const Eigen::Vector3f& top_m,
             const Material& steel) {
  piece.add_bar({.from_m = foot_m, .to_m = top_m, .radius_m = 0.011F, .num_sides = 8}, steel);
}

// Four straight legs under the corners of a board, a little inside of its edges.
void add_legs(Piece& piece, const Eigen::Vector2f& board_m, float height_m, const Material& steel) {
  constexpr float kInset_m = 0.05F;
  const Eigen::Vector2f half_m = 0.5F * board_m - Eigen::Vector2f::Constant(kInset_m);
  for (const float x : {-1.0F, 1.0F}) {
    for (const float z : {-1.0F, 1.0F}) {
      const Eigen::Vector3f foot_m(x * half_m.x(), 0.0F, z * half_m.y());
      piece.add_bar({.from_m = foot_m,
                     .to_m = foot_m + height_m * Eigen::Vector3f::UnitY(),
                     .radius_m = 0.02F,
                     .num_sides = 8},
                    steel);
    }
  }
}

// A sheet that leans back: from its lower edge, `lean` metres to the rear over its height.
void add_leaning(Piece& piece, const Box& upright, float lean_m, const Material& material) {
  const Eigen::Vector3f size_m = upright.high_m - upright.low_m;
  const Eigen::Vector3f up = Eigen::Vector3f(0.0F, size_m.y(), -lean_m).normalized();
  const Eigen::Vector3f right = Eigen::Vector3f::UnitX();
  const Eigen::Vector3f corner_m(upright.low_m.x(), upright.low_m.y(), upright.high_m.z());
  const float height_m = std::hypot(size_m.y(), lean_m);
  const float thick_m = size_m.z();
  const Eigen::Vector3f out = right.cross(up);
  const Eigen::Vector3f rear_m = corner_m - thick_m * out;
  const Eigen::Vector2f face_m(size_m.x(), height_m);
  piece.add_panel({corner_m, right, up, face_m}, material);
  piece.add_panel({rear_m + size_m.x() * right, -right, up, face_m}, material);
  piece.add_panel({rear_m, out, up, {thick_m, height_m}}, material);
  piece.add_panel({corner_m + size_m.x() * right, -out, up, {thick_m, height_m}}, material);
  piece.add_panel({corner_m + height_m * up, right, -out, {size_m.x(), thick_m}}, material);
}

}  // namespace

void Furnisher::add_chair(const Spot& spot) {
  constexpr float kSeat_m = 0.45F;
  Piece piece = piece_at(spot);
  const Colour shells[] = {palette_.upholstery, paints::kBlack, 0.9F * paints::kWhite,
                           palette_.wood, paints::kGrey};
  const Colour colour = piece.draws().blend(shells);
  const bool is_soft = piece.draws().happens(0.5);
  const Finish finish = is_soft ? Finish::kFabric : Finish::kPlastic;
  const Material seat = piece.made_of(finish, colour, 0.8F * colour);
  const Material back = piece.made_of(finish, colour, 0.8F * colour);
  const Material steel = piece.made_of(Finish::kSteel, paints::kMetal);
  const float thick_m = is_soft ? 0.045F : 0.014F;
  piece.begin_object("chair");
  piece.add_block({{-0.22F, kSeat_m - thick_m, -0.21F}, {0.22F, kSeat_m, 0.22F}}, seat);
  add_leaning(piece, {{-0.21F, 0.56F, -0.21F - thick_m}, {0.21F, 0.86F, -0.21F}}, 0.06F, back);
  for (const float x : {-1.0F, 1.0F}) {
    add_leg(piece, {x * 0.225F, 0.0F, 0.21F}, {x * 0.19F, kSeat_m - thick_m, 0.18F}, steel);
    add_leg(piece, {x * 0.225F, 0.0F, -0.25F}, {x * 0.19F, kSeat_m - thick_m, -0.17F}, steel);
    // from the seat up to the back
    add_leg(piece, {x * 0.17F, kSeat_m - 0.03F, -0.19F}, {x * 0.17F, 0.7F, -0.245F}, steel);
    piece.add_bar({.from_m = {x * 0.2F, kSeat_m - thick_m - 0.01F, -0.17F},
                   .to_m = {x * 0.2F, kSeat_m - thick_m - 0.01F, 0.18F},
                   .radius_m = 0.009F,
                   .num_sides = 6},
                  steel);
  }
  piece.end_object();
}

void Furnisher::add_table(const Spot& spot) {
  constexpr float kTop_m = 0.74F;
  const Eigen::Vector2f board_m(1.2F, 0.7F);
  Piece piece = piece_at(spot);
  const Colour tops[] = {palette_.wood, 0.9F * paints::kWhite, 0.8F * paints::kGrey};
  const Material top = piece.made_of(Finish::kWood, piece.draws().blend(tops));
  const Material steel = piece.made_of(Finish::kSteel, paints::kMetal);
  const bool has_paper = piece.draws().happens(0.5);
  const float paper_m = piece.draws().shift(0.35F);
  piece.begin_object("table");
  piece.add_block({{-0.5F * board_m.x(), kTop_m - 0.026F, -0.5F * board_m.y()},
                   {0.5F * board_m.x(), kTop_m, 0.5F * board_m.y()}},
                  top);
  add_legs(piece, board_m, kTop_m - 0.026F, steel);
  for (const float z : {-0.29F, 0.29F}) {
    piece.add_block({{-0.53F, kTop_m - 0.07F, z - 0.012F}, {0.53F, kTop_m - 0.026F, z + 0.012F}},
                    steel);
  }
  if (has_paper) {
    Material paper = piece.made_of(Finish::kPaper, paints::kWhite, paints::kBlue);
    paper.own_ratio = 0.0F;
    piece.add_panel({.corner_m = {paper_m - 0.105F, kTop_m + 6e-4F, 0.15F},
                     .up = -Eigen::Vector3f::UnitZ(),
                     .size_m = {0.21F, 0.297F}},
                    paper);
  }
  piece.begin_part(0);
  add_clutter(piece, {{-0.57F, kTop_m, -0.33F}, {0.57F, kTop_m + 0.25F, -0.1F}});
  piece.end_object();
}

// One sits behind it and looks at the screen's front: the desk's own front is its far side.
void Furnisher::add_desk(const Spot& spot) {
  constexpr float kTop_m = 0.73F;
  const Eigen::Vector2f board_m(1.6F, 0.8F);
  Piece piece = piece_at(spot);
  const Colour tops[] = {palette_.wood, 0.9F * paints::kWhite, 0.8F * paints::kGrey};
  const Material top = piece.made_of(Finish::kWood, piece.draws().blend(tops));
  const Material steel = piece.made_of(Finish::kSteel, paints::kMetal);
  const Material grey = piece.made_of(Finish::kPaint, paints::kGrey);
  const Material black = piece.made_of(Finish::kPlastic, paints::kBlack);
  piece.begin_object("desk");
  piece.add_block({{-0.8F, kTop_m - 0.025F, -0.4F}, {0.8F, kTop_m, 0.4F}}, top);
  add_legs(piece, board_m, kTop_m - 0.025F, steel);
  piece.add_block({{-0.74F, 0.35F, 0.33F}, {0.74F, 0.7F, 0.348F}}, grey);
  piece.add_block({{0.32F, 0.05F, -0.36F}, {0.72F, 0.6F, 0.24F}}, grey);
  for (const float y_m : {0.2F, 0.38F, 0.55F}) {
    piece.add_block({{0.44F, y_m, -0.385F}, {0.6F, y_m + 0.012F, -0.36F}}, steel);
  }
  const float x_m = piece.draws().shift(0.2F);
  piece.add_block({{x_m - 0.27F, kTop_m + 0.11F, 0.10F}, {x_m + 0.27F, kTop_m + 0.44F, 0.14F}},
                  black);
  piece.add_block({{x_m - 0.03F, kTop_m, 0.13F}, {x_m + 0.03F, kTop_m + 0.25F, 0.16F}}, black);
  piece.add_block({{x_m - 0.12F, kTop_m, 0.05F}, {x_m + 0.12F, kTop_m + 0.008F, 0.22F}}, black);
  const Material keys = piece.made_of(Finish::kGrille, 2.0F * paints::kBlack);
  piece.add_box({{x_m - 0.22F, kTop_m, -0.25F}, {x_m + 0.22F, kTop_m + 0.015F, -0.11F}},
                {black, keys});
  Material paper = piece.made_of(Finish::kPaper, paints::kWhite, paints::kGreen);
  paper.own_ratio = 0.0F;
  piece.add_panel({.corner_m = {-0.7F, kTop_m + 6e-4F, 0.1F + piece.draws().shift(0.1F)},
                   .up = -Eigen::Vector3f::UnitZ(),
                   .size_m = {0.21F, 0.297F}},
                  paper);
  piece.begin_part(0);
  add_clutter(piece, {{-0.78F, kTop_m, -0.36F}, {-0.5F, kTop_m + 0.3F, -0.12F}});
  add_clutter(piece, {{0.5F, kTop_m, -0.3F}, {0.79F, kTop_m + 0.3F, 0.05F}});
  piece.end_object();
}

void Furnisher::add_sofa(const Spot& spot) {
  constexpr float kHalf_m = 0.85F;
  Piece piece = piece_at(spot);
  const Colour cloth = palette_.upholstery;
  Material body = piece.made_of(Finish::kFabric, cloth, 0.85F * cloth);
  const Material wood = piece.made_of(Finish::kWood, palette_.wood);
  piece.begin_object("sofa");
  piece.add_block({{-kHalf_m, 0.12F, -0.4F}, {kHalf_m, 0.3F, 0.38F}}, body);
  for (const float side : {-1.0F, 1.0F}) {
    const Material cushion = piece.made_of(Finish::kFabric, cloth, 0.85F * cloth);
    const float middle_m = side * 0.355F;
    piece.add_block({{middle_m - 0.35F, 0.3F, -0.2F}, {middle_m + 0.35F, 0.44F, 0.4F}}, cushion);
    add_leaning(piece, {{middle_m - 0.35F, 0.44F, -0.3F}, {middle_m + 0.35F, 0.82F, -0.16F}}, 0.08F,
                cushion);
    const float arm_m = side * 0.785F;
    piece.add_block({{arm_m - 0.075F, 0.3F, -0.4F}, {arm_m + 0.075F, 0.58F, 0.4F}}, body);
    for (const float z_m : {-0.35F, 0.33F}) {
      piece.add_block({{side * 0.78F - 0.025F, 0.0F, z_m - 0.025F},
                       {side * 0.78F + 0.025F, 0.12F, z_m + 0.025F}},
                      wood);
    }
  }
  piece.add_block({{-0.71F, 0.3F, -0.4F}, {0.71F, 0.76F, -0.31F}}, body);
  piece.end_object();
}

}  // namespace samewhere::twin
