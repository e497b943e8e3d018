#include <array>
#include <cmath>

#include <fmt/format.h>

#include <samewhere/twin/building/noise.hpp>
#include <samewhere/twin/building/piece.hpp>

namespace samewhere::twin {
namespace {

Stance world_from_unit(const core::Rigid3& world_from_unit, const Stance& stand) {
  const Eigen::Matrix3f turn = world_from_unit.rotation.toRotationMatrix().cast<float>();
  return {.origin_m = turn * stand.origin_m + world_from_unit.translation.cast<float>(),
          .axes = turn * stand.axes};
}

// As lacquered, polished or worn as such things are.
float usual_gloss(Finish finish) {
  switch (finish) {
    case Finish::kSteel:
      return 4.0F;  // metals mirror more than any varnish
    case Finish::kFloorTiles:
      return 0.8F;
    case Finish::kPlate:
    case Finish::kSign:
    case Finish::kPlastic:
      return 0.6F;
    case Finish::kPaint:
    case Finish::kPlanks:
    case Finish::kWood:
      return 0.45F;
    default:
      return 0.0F;
  }
}

// Half the angle over which it blurs what it mirrors.
float usual_roughness_rad(Finish finish) {
  switch (finish) {
    case Finish::kSteel:
      return 0.14F;  // brushed
    case Finish::kFloorTiles:
    case Finish::kPlanks:
      return 0.05F;
    default:
      return 0.08F;
  }
}

}  // namespace

namespace paints {
const Colour kGrey = colour_of_srgb(0.50F, 0.52F, 0.54F);
const Colour kWhite = colour_of_srgb(0.90F, 0.90F, 0.88F);
const Colour kBlack = colour_of_srgb(0.12F, 0.12F, 0.13F);
const Colour kMetal = colour_of_srgb(0.66F, 0.66F, 0.67F);
const Colour kRed = colour_of_srgb(0.78F, 0.12F, 0.10F);
const Colour kGreen = colour_of_srgb(0.05F, 0.50F, 0.30F);
const Colour kCork = colour_of_srgb(0.68F, 0.52F, 0.34F);
const Colour kDaylight = colour_of_srgb(0.90F, 0.95F, 1.0F);
const Colour kLampWhite = colour_of_srgb(1.0F, 0.97F, 0.90F);
const Colour kRubber = colour_of_srgb(0.28F, 0.27F, 0.27F);
const Colour kCarton = colour_of_srgb(0.70F, 0.56F, 0.41F);
const Colour kPalletWood = colour_of_srgb(0.72F, 0.62F, 0.48F);
const Colour kOrange = colour_of_srgb(0.85F, 0.42F, 0.12F);
const Colour kBlue = colour_of_srgb(0.16F, 0.30F, 0.52F);
}  // namespace paints

// A ramp for each channel, a third of the circle apart.
Colour hue_colour(double hue, double lightness) {
  const auto channel = [&](double shift) {
    const double wave = std::abs(std::fmod(hue + shift, 1.0) * 2.0 - 1.0);
    return static_cast<float>(lightness * (0.55 + 0.45 * wave));
  };
  return colour_of_srgb(channel(0.0), channel(1.0 / 3.0), channel(2.0 / 3.0));
}

Box centred(const Eigen::Vector2f& middle_m, const Eigen::Vector2f& size_m,
            const Eigen::Vector2f& out_m) {
  const Eigen::Vector2f low = middle_m - 0.5F * size_m;
  const Eigen::Vector2f high = middle_m + 0.5F * size_m;
  return {{low.x(), low.y(), out_m.x()}, {high.x(), high.y(), out_m.y()}};
}

Piece::Piece(const Site& site, const Stance& stand_in_unit)
    : Shapes(site.building.rectangles,
             world_from_unit(
                 site.building.units.at(static_cast<std::size_t>(site.unit)).world_from_unit,
                 stand_in_unit)),
      site_(site),
      draws_(site.style, site.thing) {}

void Piece::begin_part(int part) {
  constexpr std::uint64_t kStride = 0x9e3779b97f4a7c15ULL;
  const std::uint64_t mixed = site_.thing + (static_cast<std::uint64_t>(part) + 1) * kStride;
  draws_ = Draws(site_.style, scramble(mixed));
}

Material Piece::made_of(Finish finish, const Colour& colour, const Colour& second) {
  return {.finish = finish,
          .colour = colour,
          .second = second,
          .wear_seed = draws_.own_seed(),
          .pattern_seed = draws_.common_seed(),
          .own_pattern_seed = draws_.own_seed(),
          .own_ratio = draws_.own_ratio(),
          .gloss = usual_gloss(finish),
          .roughness_rad = usual_roughness_rad(finish)};
}

Material Piece::running(Finish finish, const Colour& colour, const Colour& second,
                        std::uint32_t plane) const {
  const Palette& palette = site_.palette;
  return {.finish = finish,
          .colour = colour,
          .second = second,
          .wear_seed = scramble(palette.wear_seed + plane),
          .pattern_seed = scramble(palette.pattern_seed + plane),
          .own_pattern_seed = scramble(palette.own_pattern_seed + plane),
          .own_ratio = draws_.own_ratio(),
          .gloss = usual_gloss(finish),
          .roughness_rad = usual_roughness_rad(finish)};
}

void Piece::begin_object(const std::string& name, bool is_unique) {
  auto& objects = site_.building.objects;
  set_object(static_cast<int>(objects.size()));
  objects.push_back(
      {.name = is_unique ? name : fmt::format("{} {}-{}", name, site_.unit, site_.thing),
       .unit = site_.unit,
       .is_unique = is_unique});
}

void Piece::add_paper(const Box& sheet, double min_own, Cover cover) {
  constexpr int kNumPrints = 1 << 30;
  const int drawn = draws_.pick(kNumPrints, min_own);
  const bool is_own = draws_.was_own();
  auto print = scramble(static_cast<std::uint32_t>(drawn));
  // half of what hangs there is new at another visit
  const auto news =
      static_cast<std::uint32_t>(core::seed_of(site_.style.visit, "twin.news", draws_.own_seed()));
  const bool is_new = site_.style.visit > 0 && (news & 1U) != 0;
  if (is_new) print = scramble(news);
  core::Random look(print);
  const bool is_white = look.uniform() < 0.6;
  const Colour tint = 0.5F * (paints::kWhite + hue_colour(look.uniform(), 1.0));
  Material paper =
      made_of(Finish::kPaper, is_white ? paints::kWhite : tint, hue_colour(look.uniform(), 0.7));
  paper.pattern_seed = paper.own_pattern_seed = print;
  paper.own_ratio = 0.0F;
  paper.gloss = cover == Cover::kGlass ? 1.0F : 0.0F;
  paper.roughness_rad = 0.0F;
  if (is_own || is_new) {
    begin_object(fmt::format("paper {:08x}", print), true);
  } else {
    begin_object("paper");
  }
  add_box(sheet, {paper, paper});
  end_object();
}

void Piece::add_frame(const Box& around, float width_m, const Material& material) {
  const Eigen::Vector3f& low = around.low_m;
  const Eigen::Vector3f& high = around.high_m;
  const float w = width_m;
  const Cladding cladding{material, material};
  add_box({{low.x() - w, high.y(), low.z()}, {high.x() + w, high.y() + w, high.z()}}, cladding);
  if (low.y() > 0.0F) {
    add_box({{low.x() - w, low.y() - w, low.z()}, {high.x() + w, low.y(), high.z()}}, cladding);
  }
  add_box({{low.x() - w, low.y(), low.z()}, {low.x(), high.y(), high.z()}}, cladding);
  add_box({{high.x(), low.y(), low.z()}, {high.x() + w, high.y(), high.z()}}, cladding);
}

}  // namespace samewhere::twin
