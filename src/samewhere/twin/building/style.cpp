#include <algorithm>

#include <samewhere/twin/building/style.hpp>

namespace samewhere::twin {

Draws::Draws(const Style& style, std::uint64_t thing)
    : similarity_(style.similarity),
      common_(core::seed_of(style.common_seed, "twin.common", thing)),
      own_(core::seed_of(style.own_seed, "twin.own", thing)) {}

float Draws::blend(float low, float high) {
  const double common = common_.uniform(low, high);
  const double own = own_.uniform(low, high);
  return static_cast<float>(similarity_ * common + (1.0 - similarity_) * own);
}

double Draws::pick_uniform(double own_chance) {
  const double common = common_.uniform();
  const double own = own_.uniform();
  was_own_ = own_.uniform() < own_chance;
  return was_own_ ? own : common;
}

int Draws::pick(int count, double min_own) {
  return static_cast<int>(pick_uniform(std::max(1.0 - similarity_, min_own)) * count);
}

Colour Draws::blend(std::span<const Colour> range) {
  const Colour& common = range[common_.index(range.size())];
  const Colour& own = range[own_.index(range.size())];
  return common + own_ratio() * (own - common);
}

namespace {

// of the things that are counted from 0
constexpr std::uint64_t kPalette = ~0ULL;

constexpr int kNumCeilings = kNumCeilingTiles + 1;

Colour rgb(float red, float green, float blue) { return colour_of_srgb(red, green, blue); }

}  // namespace

Palette::Palette(const Style& style) {
  Draws draws(style, kPalette);
  const Colour walls[] = {rgb(0.86F, 0.84F, 0.78F), rgb(0.84F, 0.85F, 0.86F),
                          rgb(0.80F, 0.84F, 0.80F), rgb(0.87F, 0.82F, 0.70F),
                          rgb(0.78F, 0.83F, 0.88F), rgb(0.87F, 0.78F, 0.74F)};
  const Colour dados[] = {rgb(0.66F, 0.70F, 0.70F), rgb(0.62F, 0.67F, 0.74F),
                          rgb(0.62F, 0.68F, 0.58F), rgb(0.74F, 0.64F, 0.50F),
                          rgb(0.50F, 0.58F, 0.66F), rgb(0.70F, 0.56F, 0.52F)};
  const Colour woods[] = {rgb(0.74F, 0.57F, 0.38F), rgb(0.58F, 0.40F, 0.26F),
                          rgb(0.82F, 0.72F, 0.56F), rgb(0.55F, 0.60F, 0.66F),
                          rgb(0.80F, 0.80F, 0.77F), rgb(0.48F, 0.56F, 0.48F)};
  const Colour frames[] = {rgb(0.50F, 0.52F, 0.54F), rgb(0.36F, 0.38F, 0.40F),
                           rgb(0.84F, 0.84F, 0.81F), rgb(0.42F, 0.34F, 0.28F)};
  const Colour carpets[] = {rgb(0.40F, 0.44F, 0.50F), rgb(0.46F, 0.40F, 0.38F),
                            rgb(0.36F, 0.43F, 0.40F), rgb(0.50F, 0.36F, 0.34F),
                            rgb(0.45F, 0.45F, 0.44F), rgb(0.34F, 0.37F, 0.52F)};
  const Colour flecks[] = {rgb(0.72F, 0.68F, 0.56F), rgb(0.62F, 0.62F, 0.66F),
                           rgb(0.30F, 0.30F, 0.36F), rgb(0.70F, 0.54F, 0.44F)};
  const Colour floors[] = {rgb(0.72F, 0.70F, 0.66F), rgb(0.62F, 0.61F, 0.60F),
                           rgb(0.74F, 0.66F, 0.56F), rgb(0.52F, 0.54F, 0.56F)};
  const Colour cloths[] = {rgb(0.25F, 0.30F, 0.42F), rgb(0.35F, 0.36F, 0.37F),
                           rgb(0.48F, 0.24F, 0.22F), rgb(0.26F, 0.38F, 0.30F),
                           rgb(0.56F, 0.46F, 0.30F), rgb(0.16F, 0.16F, 0.18F)};
  wall = draws.blend(walls);
  dado = draws.blend(dados);
  wood = draws.blend(woods);
  frame = draws.blend(frames);
  carpet = draws.blend(carpets);
  fleck = draws.blend(flecks);
  floor = draws.blend(floors);
  upholstery = draws.blend(cloths);
  joint = 0.6F * floor;
  ceiling = rgb(0.91F, 0.90F, 0.87F);
  skirting = 0.45F * frame + 0.1F * wood;
  pattern_seed = draws.common_seed();
  own_pattern_seed = draws.own_seed();
  wear_seed = draws.own_seed();
  choose_fittings(draws);
}

void Palette::choose_fittings(Draws& draws) {
  ceiling_design = draws.design();
  ceiling_kind = Choices(ceiling_design).next(kNumCeilings);
  constexpr std::array kSkirtings_m = {0.09F, 0.06F, 0.12F, 0.16F};
  skirting_m = Choices(draws.common_seed()).of(kSkirtings_m);  // one for all: units meet

  stair_design = draws.design();

  Choices doors(draws.design());
  constexpr std::array kFrames_m = {0.07F, 0.04F, 0.055F};
  constexpr std::array kClosers = {Closer::kNone, Closer::kAtHinges, Closer::kAcross};
  constexpr std::array kHandles = {Handle::kLeverOnPlate, Handle::kLeverOnRose, Handle::kBar};
  constexpr std::array kPlates_m = {1.55F, 1.40F, 1.72F};
  door.frame_m = doors.of(kFrames_m);
  door.is_mirrored = doors.next(2) == 1;
  door.closer = doors.of(kClosers);
  door.handle = doors.of(kHandles);
  door.plate_m = doors.of(kPlates_m);

  Choices windows(draws.design());
  const std::array<Eigen::Vector2f, 4> panes_m = {
      {{1.4F, 1.2F}, {1.2F, 1.3F}, {1.4F, 0.9F}, {1.05F, 1.1F}}};
  window.pane_m = windows.of(panes_m);
  window.dressing = windows.next(kNumDressings * kNumSlatWidths);
  window.has_sill = windows.next(3) != 0;
  window.num_bars = windows.next(3);
}

}  // namespace samewhere::twin
