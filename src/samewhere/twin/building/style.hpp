#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <samewhere/core/random.hpp>
#include <samewhere/twin/building/surface.hpp>

namespace samewhere::twin {

// How a unit is decorated. Look-alikes have the same common seed and own seeds that differ.
struct Style {
  std::uint64_t common_seed = 0;
  std::uint64_t own_seed = 1;
  double similarity = 0.8;  // in [0, 1]
  // At another visit of the same building half of the papers on its walls are new ones.
  std::uint64_t visit = 0;
};

// Over the usual: 0 is off.
struct LightSetting {
  float lamps = 1.0F;
  float daylight = 1.0F;
};

// Decisions about one thing. Each is drawn twice, once from what all look-alikes share and once for
// this one alone; similarity s says how the two make one. Every decision takes the same number of
// draws whatever comes out, and things do not share generators: look-alikes stay in step.
class Draws {
 public:
  // `thing`: counts the things of a unit, the same for look-alikes.
  Draws(const Style& style, std::uint64_t thing);

  // Continuous looks: s common + (1 - s) own, each uniform in [low, high).
  float blend(float low, float high);
  // Of colours, each one of a range.
  Colour blend(std::span<const Colour> range);
  // Discrete choices: own with a chance of 1 - s, or `min_own` if that is more.
  int pick(int count, double min_own = 0.0);
  bool happens(double chance) { return pick_uniform(own_ratio()) < chance; }
  // To the left or right by up to `most`: a small change of place.
  float shift(float most) {
    return static_cast<float>(most * (2.0 * pick_uniform(own_ratio()) - 1.0));
  }

  std::uint32_t common_seed() { return static_cast<std::uint32_t>(common_.next()); }
  std::uint32_t own_seed() { return static_cast<std::uint32_t>(own_.next()); }
  // True where the last discrete choice was this one's own.
  bool was_own() const { return was_own_; }
  // Many small choices that go together, own or common as one. Own with a chance of (1 - s)^2 only:
  // one draw decides on all doors of a unit, and the same fittings run through a building long
  // before its rooms are alike in everything else.
  std::uint32_t design() {
    return static_cast<std::uint32_t>(pick_uniform(own_ratio() * own_ratio()) * (1 << 30));
  }
  float own_ratio() const { return static_cast<float>(1.0 - similarity_); }

 private:
  // In [0, 1): own with that chance, else common.
  double pick_uniform(double own_chance);

  double similarity_;
  core::Random common_;
  core::Random own_;
  bool was_own_ = false;
};

// Small numbers out of one design, one after the other.
class Choices {
 public:
  explicit Choices(std::uint32_t design) : rest_(design) {}

  // Below `count`.
  int next(int count) {
    const auto n = static_cast<std::uint32_t>(count);
    const auto choice = static_cast<int>(rest_ % n);
    rest_ /= n;
    return choice;
  }
  // One of a list.
  template <class T, std::size_t n>
  const T& of(const std::array<T, n>& list) {
    return list[static_cast<std::size_t>(next(static_cast<int>(n)))];
  }

 private:
  std::uint32_t rest_;
};

enum class Closer : std::uint8_t { kNone, kAtHinges, kAcross };
enum class Handle : std::uint8_t { kLeverOnPlate, kLeverOnRose, kBar };

// How all doors of a unit are made.
struct DoorDesign {
  float frame_m = 0.07F;     // width, at most 0.07
  bool is_mirrored = false;  // the handle on the left
  Closer closer = Closer::kNone;
  Handle handle = Handle::kLeverOnPlate;
  float plate_m = 1.55F;  // height of the number
};

// How all windows of a unit are made and dressed.
struct WindowDesign {
  Eigen::Vector2f pane_m{1.4F, 1.2F};
  int dressing = 0;  // as Finish::kBlinds reads it
  bool has_sill = true;
  int num_bars = 0;  // upright, between panes
};

// The colours, patterns and fittings that run through a whole unit.
struct Palette {
  explicit Palette(const Style& style);

  Colour wall, dado, wood, frame, carpet, fleck, floor, joint, ceiling, skirting, upholstery;
  std::uint32_t pattern_seed = 0;
  std::uint32_t own_pattern_seed = 0;
  std::uint32_t wear_seed = 0;
  // Of tiled ceilings: which kind, and where the grid begins.
  int ceiling_kind = 0;
  std::uint32_t ceiling_design = 0;
  std::uint32_t stair_design = 0;  // of walls that are bricks by default
  float skirting_m = 0.09F;        // height
  DoorDesign door;
  WindowDesign window;

 private:
  void choose_fittings(Draws& draws);
};

}  // namespace samewhere::twin
