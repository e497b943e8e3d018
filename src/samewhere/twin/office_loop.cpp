#include <algorithm>
#include <array>

#include <samewhere/twin/furnisher.hpp>
#include <samewhere/twin/office_loop.hpp>

namespace samewhere::twin {
namespace {

constexpr float kHeight_m = 2.6F;
// half the size of the outer walls and of the block inside
const Eigen::Vector2f kOuter_m(8.0F, 5.0F);
const Eigen::Vector2f kInner_m(6.0F, 3.0F);
constexpr int kFirstRoom = 301;

// What stands in the middle of a stretch of wall.
enum class Bay { kDoor, kWindow };

// A stretch of wall between two corners of the plan, from left to right as seen.
struct Side {
  Wall wall;
  std::vector<Bay> bays;
};

std::array<Side, 8> sides() {
  const auto d = Bay::kDoor;
  const auto w = Bay::kWindow;
  const float x = kOuter_m.x();
  const float y = kOuter_m.y();
  const float a = kInner_m.x();
  const float b = kInner_m.y();
  return {{{{{x, -y}, {-x, -y}, 0.0F, kHeight_m}, {d, d, d, d, d, d}},
           {{{x, y}, {x, -y}, 0.0F, kHeight_m}, {d, w, w, d}},
           {{{-x, y}, {x, y}, 0.0F, kHeight_m}, {d, d, d, d, d, d}},
           {{{-x, -y}, {-x, y}, 0.0F, kHeight_m}, {d, w, w, d}},
           {{{-a, -b}, {a, -b}, 0.0F, kHeight_m}, {d, d, d, d, d}},
           {{{a, -b}, {a, b}, 0.0F, kHeight_m}, {d, d}},
           {{{a, b}, {-a, b}, 0.0F, kHeight_m}, {d, d, d, d, d}},
           {{{-a, b}, {-a, -b}, 0.0F, kHeight_m}, {d, d}}}};
}

class Builder {
 public:
  Builder(std::uint64_t seed, double similarity)
      : building_{.units = {Unit{}}},
        furnisher_(building_, 0,
                   {.common_seed = seed, .own_seed = ~seed, .similarity = similarity}),
        layout_(core::seed_of(seed, "twin.layout", 0)) {}

  std::vector<Rectangle> build() {
    add_floor_and_ceiling();
    for (const auto& side : sides()) add_side(side);
    add_ceiling_things();
    return std::move(building_.rectangles);
  }

 private:
  void add_floor_and_ceiling() {
    const Eigen::Vector2f outer = kOuter_m;
    const Eigen::Vector2f inner = kInner_m;
    const std::array<std::array<Eigen::Vector2f, 2>, 4> legs = {
        {{Eigen::Vector2f(-outer), Eigen::Vector2f(outer.x(), -inner.y())},
         {Eigen::Vector2f(-outer.x(), inner.y()), outer},
         {Eigen::Vector2f(inner.x(), -inner.y()), Eigen::Vector2f(outer.x(), inner.y())},
         {Eigen::Vector2f(-outer.x(), -inner.y()), Eigen::Vector2f(-inner.x(), inner.y())}}};
    for (const auto& [low, high] : legs) {
      furnisher_.add_floor(low, high, 0.0F, FloorFinish::kCarpet);
      furnisher_.add_ceiling(low, high, kHeight_m, CeilingFinish::kTiles);
    }
  }

  void add_side(const Side& side) {
    furnisher_.add_wall(side.wall, 0.0F, kHeight_m, WallFinish::kBlocks);
    const float pitch_m =
        (side.wall.to_m - side.wall.from_m).norm() / static_cast<float>(side.bays.size());
    for (std::size_t i = 0; i < side.bays.size(); ++i) {
      const float start_m = pitch_m * static_cast<float>(i);
      add_bay({side.wall, start_m + 0.5F * pitch_m}, side.bays[i], pitch_m);
      const bool is_last = i + 1 == side.bays.size();
      if (is_last) continue;
      const bool has_room = side.bays[i] == Bay::kDoor && side.bays[i + 1] == Bay::kDoor;
      add_decoration({side.wall, start_m + pitch_m}, has_room);
    }
    furnisher_.add_cable_duct(side.wall);
  }

  void add_bay(const Place& place, Bay bay, float pitch_m) {
    constexpr float kHalfDoor_m = 0.52F;
    const float half_gap_m = bay == Bay::kDoor ? kHalfDoor_m : 0.0F;
    for (const float sign : {-1.0F, 1.0F}) {
      const float near_m = place.along_m + sign * half_gap_m;
      const float far_m = place.along_m + sign * 0.5F * pitch_m;
      furnisher_.add_skirting(place.wall, std::min(near_m, far_m), std::max(near_m, far_m));
    }
    if (bay == Bay::kDoor) return furnisher_.add_door(place, next_room_++);
    furnisher_.add_window(place, Daylight::kBlinds);
    furnisher_.add_radiator(place);
  }

  // Between two doors or windows; beside windows there is room for narrow things only.
  void add_decoration(const Place& place, bool has_room) {
    Place shifted = place;
    shifted.along_m += static_cast<float>(layout_.uniform(-0.06, 0.06));
    constexpr int kNumWide = 4;
    const auto drawn = static_cast<int>(layout_.index(8));
    switch (has_room ? drawn : kNumWide + drawn % (8 - kNumWide)) {
      case 0:
      case 1:
      case 2:
        return furnisher_.add_notice_board(shifted);
      case 3:
        return furnisher_.add_cabinet(shifted);
      case 4:
      case 5:
        return furnisher_.add_framed_poster(shifted);
      case 6:
        return furnisher_.add_extinguisher(shifted);
      default:
        return furnisher_.add_switch(shifted);
    }
  }

  void add_ceiling_things() {
    const float x = 0.5F * (kOuter_m.x() + kInner_m.x());
    const float y = 0.5F * (kOuter_m.y() + kInner_m.y());
    for (const float sign : {-1.0F, 1.0F}) {
      for (int i = -3; i <= 3; ++i) {
        const float along = 2.4F * static_cast<float>(i);
        furnisher_.add_ceiling_lamp({along, sign * y}, {1.2F, 0.3F}, kHeight_m);
        if (i % 2 == 0) furnisher_.add_ceiling_vent({along + 1.2F, sign * y}, kHeight_m);
      }
      for (int i = -1; i <= 1; ++i) {
        const float along = 2.4F * static_cast<float>(i);
        furnisher_.add_ceiling_lamp({sign * x, along}, {0.3F, 1.2F}, kHeight_m);
      }
      furnisher_.add_exit_sign({sign * 5.4F, sign * y}, 0.0F, kHeight_m);
      furnisher_.add_exit_sign({sign * x, -sign * 2.4F + 1.2F}, 1.5708F, kHeight_m);
    }
  }

  Building building_;
  Furnisher furnisher_;
  core::Random layout_;  // of its own: what stands where does not depend on similarity
  int next_room_ = kFirstRoom;
};

}  // namespace

std::vector<Rectangle> office_loop_surfaces(std::uint64_t seed, double similarity) {
  return Builder(seed, similarity).build();
}

}  // namespace samewhere::twin
