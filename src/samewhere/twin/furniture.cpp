#include <algorithm>
#include <cmath>

#include <samewhere/twin/furniture.hpp>

namespace samewhere::twin {
namespace {

const Colour kBeech = colour_of_srgb(0.74F, 0.57F, 0.38F);
const Colour kGreyPaint = colour_of_srgb(0.50F, 0.52F, 0.54F);
const Colour kWhite = colour_of_srgb(0.90F, 0.90F, 0.88F);
const Colour kBlack = colour_of_srgb(0.12F, 0.12F, 0.13F);
const Colour kMetal = colour_of_srgb(0.66F, 0.66F, 0.67F);
const Colour kRed = colour_of_srgb(0.78F, 0.12F, 0.10F);
const Colour kGreen = colour_of_srgb(0.05F, 0.50F, 0.30F);
const Colour kCorkBrown = colour_of_srgb(0.68F, 0.52F, 0.34F);
const Colour kDaylight = colour_of_srgb(0.90F, 0.95F, 1.0F);
const Colour kLampWhite = colour_of_srgb(1.0F, 0.97F, 0.90F);

// A colour of any hue, somewhat greyed: a ramp for each channel, a third of the circle apart.
Colour hue_colour(double hue, double lightness) {
  const auto channel = [&](double shift) {
    const double wave = std::abs(std::fmod(hue + shift, 1.0) * 2.0 - 1.0);
    return static_cast<float>(lightness * (0.55 + 0.45 * wave));
  };
  return colour_of_srgb(channel(0.0), channel(1.0 / 3.0), channel(2.0 / 3.0));
}

// +1 where the world's axis along the wall runs to the right for who looks at the wall.
float right_sign(const WallSide& side) {
  return (side.face.axis == 0) == (side.face.facing > 0.0F) ? 1.0F : -1.0F;
}

Mounted centred(const Eigen::Vector2f& middle_m, const Eigen::Vector2f& size_m,
                const Eigen::Vector2f& out_m) {
  const Eigen::Vector2f half(-0.5F, 0.5F);
  return {Eigen::Vector2f::Constant(middle_m.x()) + size_m.x() * half,
          Eigen::Vector2f::Constant(middle_m.y()) + size_m.y() * half, out_m};
}

}  // namespace

Furnisher::Furnisher(std::vector<Rectangle>& rectangles, std::uint64_t seed, double similarity)
    : rectangles_(rectangles),
      seed_(seed),
      similarity_(similarity),
      random_(core::seed_of(seed, "twin.furniture", 0)) {}

std::uint32_t Furnisher::common_seed(std::uint64_t what) const {
  return static_cast<std::uint32_t>(core::seed_of(seed_, "twin.common", what));
}

Material Furnisher::fresh(Finish finish, const Colour& colour, const Colour& second) {
  return {.finish = finish, .colour = colour, .second = second, .wear_seed = draw_seed()};
}

Colour Furnisher::varied(const Colour& common) {
  const double hue = random_.uniform();
  const double lightness = random_.uniform(0.45, 0.85);
  return common + static_cast<float>(1.0 - similarity_) * (hue_colour(hue, lightness) - common);
}

void Furnisher::mount(const Place& place, const Mounted& mounted, const Materials& materials) {
  const Face& face = place.side.face;
  const int along = face.axis == 0 ? 1 : 0;
  // `along` is given to the right as seen; the world's axis may run to the left
  const float sign = right_sign(place.side);
  const float ends[2] = {place.along_m + sign * mounted.along_m.x(),
                         place.along_m + sign * mounted.along_m.y()};
  const float depths[2] = {place.side.plane_m + face.facing * mounted.out_m.x(),
                           place.side.plane_m + face.facing * mounted.out_m.y()};
  Box box;
  box.low_m[along] = std::min(ends[0], ends[1]);
  box.high_m[along] = std::max(ends[0], ends[1]);
  box.low_m[face.axis] = std::min(depths[0], depths[1]);
  box.high_m[face.axis] = std::max(depths[0], depths[1]);
  box.low_m.z() = mounted.up_m.x();
  box.high_m.z() = mounted.up_m.y();
  for (const auto& rectangle : faces_of(box, face, materials)) rectangles_.push_back(rectangle);
}

void Furnisher::mount(const Place& place, const Mounted& mounted, const Material& material) {
  mount(place, mounted, {material, material});
}

void Furnisher::mount_frame(const Place& place, const Mounted& around, float width_m,
                            const Material& material) {
  const Eigen::Vector2f w(-width_m, width_m);
  Mounted piece = around;
  piece.along_m += w;
  piece.up_m = {around.up_m.y(), around.up_m.y() + width_m};
  mount(place, piece, material);
  piece.up_m = {around.up_m.x() - width_m, around.up_m.x()};
  if (piece.up_m.x() > 0.0F) mount(place, piece, material);
  piece.up_m = around.up_m;
  piece.along_m = {around.along_m.x() - width_m, around.along_m.x()};
  mount(place, piece, material);
  piece.along_m = {around.along_m.y(), around.along_m.y() + width_m};
  mount(place, piece, material);
}

void Furnisher::add_strip(const WallSide& side, const Mounted& strip, const Material& material) {
  // the ends of a strip are world coordinates: undo the turn to the right
  Mounted turned = strip;
  turned.along_m *= right_sign(side);
  mount({side, 0.0F}, turned, material);
}

Material Furnisher::door_wood() {
  Material wood = fresh(Finish::kWood, varied(kBeech), kBeech);
  wood.pattern_seed = common_seed(1);
  wood.own_pattern_seed = draw_seed();
  wood.own_ratio = static_cast<float>(1.0 - similarity_);
  return wood;
}

void Furnisher::add_door(const Place& place, int number) {
  constexpr float kWidth_m = 0.90F;
  constexpr float kHeight_m = 2.05F;
  const Mounted leaf{{-0.5F * kWidth_m, 0.5F * kWidth_m}, {0.0F, kHeight_m}, {0.0F, 0.015F}};
  mount(place, leaf, door_wood());
  Mounted frame = leaf;
  frame.out_m.y() = 0.04F;
  mount_frame(place, frame, 0.07F, fresh(Finish::kPaint, varied(kGreyPaint), kGreyPaint));
  add_door_hardware(place);

  Material plate = fresh(Finish::kPlate, kWhite, colour_of_srgb(0.10F, 0.15F, 0.35F));
  plate.number = number;
  mount(place, centred({0.68F, 1.55F}, {0.17F, 0.15F}, {0.0F, 0.008F}),
        {plate, fresh(Finish::kSteel, kMetal, kMetal)});
  const int own_variant = static_cast<int>(random_.index(4));
  add_door_extras(place, is_own() ? own_variant : static_cast<int>(common_seed(2) % 4));
}

void Furnisher::add_door_hardware(const Place& place) {
  const Material steel = fresh(Finish::kSteel, kMetal, kMetal);
  mount(place, centred({0.38F, 1.02F}, {0.045F, 0.21F}, {0.015F, 0.022F}), steel);
  mount(place, centred({0.38F, 1.06F}, {0.022F, 0.022F}, {0.022F, 0.055F}), steel);
  mount(place, centred({0.325F, 1.06F}, {0.13F, 0.022F}, {0.055F, 0.070F}), steel);
  const Material hole = fresh(Finish::kPaint, kBlack, kBlack);
  mount(place, centred({0.38F, 0.96F}, {0.012F, 0.024F}, {0.022F, 0.023F}), hole);
  for (const float up_m : {0.25F, 1.0F, 1.8F}) {
    mount(place, centred({-0.437F, up_m}, {0.025F, 0.1F}, {0.015F, 0.035F}), steel);
  }
  mount(place, centred({-0.25F, 1.98F}, {0.26F, 0.06F}, {0.015F, 0.065F}), steel);
}

void Furnisher::add_door_extras(const Place& place, int variant) {
  const Material steel = fresh(Finish::kSteel, kMetal, kMetal);
  if (variant == 1 || variant == 3) {
    mount(place, centred({0.0F, 0.14F}, {0.84F, 0.24F}, {0.015F, 0.017F}), steel);
  }
  if (variant == 2 || variant == 3) {
    const Material glass = fresh(Finish::kPaint, colour_of_srgb(0.20F, 0.25F, 0.28F), kBlack);
    const Mounted pane = centred({0.18F, 1.55F}, {0.16F, 0.6F}, {0.015F, 0.017F});
    mount(place, pane, glass);
    Mounted frame = pane;
    frame.out_m.y() = 0.025F;
    mount_frame(place, frame, 0.025F, steel);
  }
}

void Furnisher::add_paper(const Place& place, const Mounted& sheet, int slot) {
  const bool has_own_print = is_own();
  const std::uint32_t own_print = draw_seed();
  const auto common_print = common_seed(100 + static_cast<std::uint64_t>(slot));
  const std::uint32_t print = has_own_print ? own_print : common_print;
  core::Random look(print);
  const Colour paper =
      look.uniform() < 0.6 ? kWhite : 0.5F * (kWhite + hue_colour(look.uniform(), 1.0));
  Material material = fresh(Finish::kPaper, paper, hue_colour(look.uniform(), 0.7));
  material.pattern_seed = print;
  mount(place, sheet, material);
}

void Furnisher::add_notice_board(const Place& place) {
  const Mounted board = centred({0.0F, 1.52F}, {1.12F, 0.84F}, {0.0F, 0.015F});
  mount(place, board, fresh(Finish::kCork, varied(kCorkBrown), kCorkBrown));
  Mounted frame = board;
  frame.out_m.y() = 0.025F;
  mount_frame(place, frame, 0.03F, fresh(Finish::kWood, kBeech, kBeech));
  constexpr int kNumColumns = 4;
  constexpr int kNumSlots = 8;
  for (int slot = 0; slot < kNumSlots; ++slot) {
    const int column = slot % kNumColumns;
    const int row = slot / kNumColumns;
    const bool is_empty = random_.uniform() < 0.5 * (1.0 - similarity_);
    const auto shift_m = static_cast<float>((1.0 - similarity_) * random_.uniform(-0.05, 0.05));
    const Eigen::Vector2f middle_m(-0.41F + 0.27F * static_cast<float>(column) + shift_m,
                                   1.32F + 0.4F * static_cast<float>(row) - shift_m);
    const float out_m = 0.0155F + 0.0004F * static_cast<float>(slot);
    const Eigen::Vector2f size_m =
        slot % 3 == 2 ? Eigen::Vector2f(0.24F, 0.17F) : Eigen::Vector2f(0.21F, 0.297F);
    if (!is_empty) add_paper(place, centred(middle_m, size_m, {0.015F, out_m}), slot);
  }
}

void Furnisher::add_framed_poster(const Place& place) {
  const Mounted sheet = centred({0.0F, 1.55F}, {0.6F, 0.84F}, {0.0F, 0.012F});
  add_paper(place, sheet, 20);
  Mounted frame = sheet;
  frame.out_m.y() = 0.022F;
  mount_frame(place, frame, 0.02F, fresh(Finish::kPaint, kBlack, kBlack));
}

void Furnisher::add_extinguisher(const Place& place) {
  const Material red = fresh(Finish::kPaint, kRed, kRed);
  mount(place, centred({0.0F, 0.75F}, {0.16F, 0.5F}, {0.03F, 0.18F}), red);
  mount(place, centred({0.0F, 1.04F}, {0.06F, 0.08F}, {0.07F, 0.14F}),
        fresh(Finish::kPaint, kBlack, kBlack));
  add_paper(place, centred({0.0F, 0.78F}, {0.12F, 0.2F}, {0.18F, 0.181F}), 30);
  mount(place, centred({0.0F, 1.75F}, {0.2F, 0.2F}, {0.0F, 0.006F}),
        fresh(Finish::kSign, kRed, kWhite));
}

void Furnisher::add_cabinet(const Place& place) {
  const Material body = fresh(Finish::kPaint, varied(kGreyPaint), kGreyPaint);
  mount(place, centred({0.0F, 0.6F}, {0.9F, 1.2F}, {0.0F, 0.30F}), body);
  const Material steel = fresh(Finish::kSteel, kMetal, kMetal);
  for (const float side : {-1.0F, 1.0F}) {
    mount(place, centred({side * 0.222F, 0.62F}, {0.43F, 1.1F}, {0.30F, 0.315F}), body);
    mount(place, centred({side * 0.05F, 0.7F}, {0.02F, 0.14F}, {0.315F, 0.335F}), steel);
  }
  add_paper(place, centred({0.22F, 0.95F}, {0.15F, 0.21F}, {0.315F, 0.316F}), 31);
}

void Furnisher::add_switch(const Place& place) {
  const Material plastic = fresh(Finish::kPaint, kWhite, kWhite);
  mount(place, centred({0.0F, 1.1F}, {0.085F, 0.085F}, {0.0F, 0.010F}), plastic);
  mount(place, centred({0.0F, 1.1F}, {0.055F, 0.055F}, {0.010F, 0.014F}), plastic);
  mount(place, centred({0.0F, 0.3F}, {0.085F, 0.085F}, {0.0F, 0.012F}), plastic);
  mount(place, centred({0.0F, 0.3F}, {0.04F, 0.04F}, {0.012F, 0.013F}),
        fresh(Finish::kPaint, kBlack, kBlack));
  mount(place, centred({0.0F, 1.85F}, {0.022F, 1.415F}, {0.0F, 0.016F}), plastic);
}

void Furnisher::add_window(const Place& place) {
  const Material white = fresh(Finish::kPaint, kWhite, kWhite);
  Material blinds = fresh(Finish::kBlinds, kDaylight, kDaylight);
  blinds.radiance = 1.3F;
  const Mounted pane = centred({0.0F, 1.55F}, {1.4F, 1.2F}, {0.0F, 0.004F});
  mount(place, pane, {blinds, white});
  Mounted frame = pane;
  frame.out_m.y() = 0.05F;
  mount_frame(place, frame, 0.06F, white);
  mount(place, centred({0.0F, 0.87F}, {1.6F, 0.03F}, {0.0F, 0.15F}), white);
  mount(place, centred({0.0F, 0.45F}, {1.3F, 0.55F}, {0.04F, 0.12F}),
        {fresh(Finish::kGrille, kWhite, kWhite), white});
}

void Furnisher::hang(const Box& box, const Materials& materials) {
  for (const auto& rectangle : faces_of(box, {.axis = 2, .facing = -1.0F}, materials)) {
    rectangles_.push_back(rectangle);
  }
}

void Furnisher::add_ceiling_lamp(const Eigen::Vector2f& middle_m, const Eigen::Vector2f& size_m,
                                 float ceiling_m) {
  Material light = fresh(Finish::kLamp, kLampWhite, kLampWhite);
  light.radiance = 13.0F;
  const Eigen::Vector2f low = middle_m - 0.5F * size_m;
  const Eigen::Vector2f high = middle_m + 0.5F * size_m;
  hang({{low.x(), low.y(), ceiling_m - 0.03F}, {high.x(), high.y(), ceiling_m}},
       {light, fresh(Finish::kPaint, kWhite, kWhite)});
}

void Furnisher::add_ceiling_vent(const Eigen::Vector2f& middle_m, float ceiling_m) {
  const Eigen::Vector2f half_m(0.24F, 0.24F);
  const Eigen::Vector2f low = middle_m - half_m;
  const Eigen::Vector2f high = middle_m + half_m;
  hang({{low.x(), low.y(), ceiling_m - 0.012F}, {high.x(), high.y(), ceiling_m}},
       {fresh(Finish::kGrille, kWhite, kWhite), fresh(Finish::kPaint, kWhite, kWhite)});
}

void Furnisher::add_exit_sign(const Eigen::Vector2f& middle_m, const Eigen::Vector2f& size_m,
                              float ceiling_m) {
  const Eigen::Vector2f low = middle_m - 0.5F * size_m;
  const Eigen::Vector2f high = middle_m + 0.5F * size_m;
  hang({{low.x(), low.y(), ceiling_m - 0.30F}, {high.x(), high.y(), ceiling_m - 0.08F}},
       {fresh(Finish::kPaint, kWhite, kWhite), fresh(Finish::kSign, kGreen, kWhite)});
  hang({{middle_m.x() - 0.01F, middle_m.y() - 0.01F, ceiling_m - 0.08F},
        {middle_m.x() + 0.01F, middle_m.y() + 0.01F, ceiling_m}},
       {fresh(Finish::kSteel, kMetal, kMetal), fresh(Finish::kSteel, kMetal, kMetal)});
}

}  // namespace samewhere::twin
