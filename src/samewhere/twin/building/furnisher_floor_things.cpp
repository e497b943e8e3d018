#include <cmath>

#include <samewhere/twin/building/angles.hpp>
#include <samewhere/twin/building/clutter.hpp>
#include <samewhere/twin/building/furnisher.hpp>
#include <samewhere/twin/building/piece.hpp>

namespace samewhere::twin {
namespace {

// A leaf from where its stem ends, its tip along `tip`, its face turned by chance about that.
Panel leaf_panel(const Eigen::Vector3f& base_m, const Eigen::Vector3f& tip,
                 const Eigen::Vector2f& size_m) {
  const Eigen::Vector3f level = Eigen::Vector3f::UnitY().cross(tip).normalized();
  return {base_m - 0.5F * size_m.x() * level, level, tip, size_m};
}

struct Crown {
  float height_m;
  float radius_m;
  int num_leaves;
  Eigen::Vector2f leaf_m;
};

// Stems that fan out from the pot, each with leaves along its upper half.
void add_crown(Piece& piece, const Crown& crown, float pot_m) {
  constexpr int kPerStem = 4;
  const Colour greens[] = {colour_of_srgb(0.20F, 0.40F, 0.16F), colour_of_srgb(0.28F, 0.46F, 0.20F),
                           colour_of_srgb(0.24F, 0.38F, 0.24F)};
  const Colour green = piece.draws().blend(greens);
  const Material stem = piece.made_of(Finish::kPaint, 0.7F * green + 0.2F * paints::kCork);
  const int num_stems = (crown.num_leaves + kPerStem - 1) / kPerStem;
  for (int i = 0; i < num_stems; ++i) {
    const float turn_rad = 2.0F * kPi_f * (static_cast<float>(i) / static_cast<float>(num_stems)) +
                           piece.draws().blend(-0.3F, 0.3F);
    const float reach_m = crown.radius_m * piece.draws().blend(0.25F, 0.8F);
    const float top_m = crown.height_m * piece.draws().blend(0.7F, 1.0F);
    const Eigen::Vector3f out(std::cos(turn_rad), 0.0F, std::sin(turn_rad));
    const Eigen::Vector3f foot_m(0.02F * out.x(), pot_m, 0.02F * out.z());
    const Eigen::Vector3f end_m = reach_m * out + top_m * Eigen::Vector3f::UnitY();
    piece.add_bar({.from_m = foot_m, .to_m = end_m, .radius_m = 0.006F, .num_sides = 6}, stem);
    for (int k = 0; k < kPerStem; ++k) {
      const float along = 0.45F + 0.18F * static_cast<float>(k);
      const float leaf_rad = turn_rad + piece.draws().blend(-2.2F, 2.2F);
      const float rise = piece.draws().blend(-0.5F, 0.9F);
      const float bright = piece.draws().blend(0.75F, 1.25F);
      const Eigen::Vector3f tip =
          Eigen::Vector3f(std::cos(leaf_rad), rise, std::sin(leaf_rad)).normalized();
      const Eigen::Vector2f size_m = crown.leaf_m * piece.draws().blend(0.7F, 1.2F);
      const Material leaf = piece.made_of(Finish::kLeaf, bright * green, 0.6F * green);
      piece.add_sheet(leaf_panel(foot_m + along * (end_m - foot_m), tip, size_m), leaf);
    }
  }
}

}  // namespace

void Furnisher::add_plant(const Spot& spot) {
  constexpr float kPot_m = 0.32F;
  Piece piece = piece_at(spot);
  const Colour pots[] = {colour_of_srgb(0.62F, 0.38F, 0.28F), paints::kWhite, paints::kBlack,
                         paints::kGrey};
  const Material pot = piece.made_of(Finish::kConcrete, piece.draws().blend(pots));
  const Material soil = piece.made_of(Finish::kSoil, colour_of_srgb(0.25F, 0.19F, 0.14F));
  const bool is_tall = piece.draws().happens(0.5);
  piece.begin_object("plant");
  piece.add_bar(
      {.to_m = {0.0F, kPot_m, 0.0F}, .radius_m = 0.16F, .num_sides = 12, .has_ends = false}, pot);
  piece.add_bar({.from_m = {0.0F, kPot_m - 0.05F, 0.0F},
                 .to_m = {0.0F, kPot_m, 0.0F},
                 .radius_m = 0.172F,
                 .num_sides = 12,
                 .has_ends = true},
                pot);
  piece.add_bar({.from_m = {0.0F, kPot_m - 0.01F, 0.0F},
                 .to_m = {0.0F, kPot_m + 0.002F, 0.0F},
                 .radius_m = 0.15F,
                 .num_sides = 12,
                 .has_ends = true},
                soil);
  const Crown tall{1.5F, 0.42F, 44, {0.09F, 0.24F}};
  const Crown low{0.95F, 0.45F, 36, {0.11F, 0.2F}};
  add_crown(piece, is_tall ? tall : low, kPot_m);
  piece.end_object();
}

void Furnisher::add_bin(const Spot& spot) {
  Piece piece = piece_at(spot);
  const Colour coats[] = {paints::kGrey, paints::kBlack, paints::kMetal, 0.7F * paints::kGreen};
  const bool is_steel = piece.draws().happens(0.5);
  const Material coat =
      piece.made_of(is_steel ? Finish::kSteel : Finish::kPlastic, piece.draws().blend(coats));
  const Material dark = piece.made_of(Finish::kPlastic, 0.3F * paints::kBlack);
  piece.begin_object("bin");
  piece.add_bar({.to_m = {0.0F, 0.6F, 0.0F}, .radius_m = 0.15F, .num_sides = 12, .has_ends = true},
                coat);
  piece.add_bar({.from_m = {0.0F, 0.57F, 0.0F},
                 .to_m = {0.0F, 0.612F, 0.0F},
                 .radius_m = 0.157F,
                 .num_sides = 12,
                 .has_ends = true},
                coat);
  piece.add_bar({.from_m = {0.0F, 0.6F, 0.0F},
                 .to_m = {0.0F, 0.6135F, 0.0F},
                 .radius_m = 0.1F,
                 .num_sides = 12,
                 .has_ends = true},
                dark);
  piece.end_object();
}

void Furnisher::add_shelf(const Spot& spot) {
  constexpr int kNumBoards = 5;
  constexpr float kPitch_m = 0.37F;
  constexpr float kHalf_m = 0.45F;
  Piece piece = piece_at(spot);
  const Colour tops[] = {palette_.wood, 0.9F * paints::kWhite, paints::kGrey};
  const Material board = piece.made_of(Finish::kWood, piece.draws().blend(tops));
  piece.begin_object("shelf");
  const float height_m = kPitch_m * static_cast<float>(kNumBoards) + 0.1F;
  for (const float side : {-1.0F, 1.0F}) {
    const float x_m = side * (kHalf_m - 0.01F);
    piece.add_block({{x_m - 0.01F, 0.0F, -0.175F}, {x_m + 0.01F, height_m, 0.175F}}, board);
  }
  piece.add_block({{-kHalf_m + 0.02F, 0.06F, -0.175F}, {kHalf_m - 0.02F, height_m, -0.165F}},
                  board);
  for (int i = 0; i <= kNumBoards; ++i) {
    const float y_m = 0.06F + kPitch_m * static_cast<float>(i);
    piece.add_box({{-kHalf_m + 0.02F, y_m, -0.165F}, {kHalf_m - 0.02F, y_m + 0.02F, 0.17F}},
                  {board, board});
    const float fill = piece.draws().blend(0.2F, 0.72F);
    const float deep_m = piece.draws().blend(0.05F, 0.14F);
    const float high_m = piece.draws().blend(0.22F, 0.32F);
    const Material books = piece.made_of(Finish::kBooks, paints::kGrey, paints::kWhite);
    if (i == kNumBoards) continue;
    piece.add_box({{-kHalf_m + 0.025F, y_m + 0.02F, -0.165F},
                   {-kHalf_m + 0.025F + 0.84F * fill, y_m + 0.02F + high_m, deep_m}},
                  {books, piece.made_of(Finish::kPlastic, paints::kGrey)});
  }
  for (int i = 0; i <= kNumBoards; ++i) {
    piece.begin_part(i);
    const float y_m = 0.08F + kPitch_m * static_cast<float>(i);
    add_clutter(piece, {{0.2F, y_m, -0.02F}, {kHalf_m - 0.03F, y_m + 0.3F, 0.165F}});
  }
  piece.end_object();
}

}  // namespace samewhere::twin
