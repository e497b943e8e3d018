#include <array>

#include <samewhere/twin/furniture.hpp>
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

struct Wall {
  WallSide side;
  std::vector<Bay> bays;
};

std::array<Wall, 8> walls() {
  const auto d = Bay::kDoor;
  const auto w = Bay::kWindow;
  const float x = kOuter_m.x();
  const float y = kOuter_m.y();
  const float a = kInner_m.x();
  const float b = kInner_m.y();
  return {{{{{1, 1.0F}, -y, -x, x}, {d, d, d, d, d, d}},
           {{{0, -1.0F}, x, -y, y}, {d, w, w, d}},
           {{{1, -1.0F}, y, -x, x}, {d, d, d, d, d, d}},
           {{{0, 1.0F}, -x, -y, y}, {d, w, w, d}},
           {{{1, -1.0F}, -b, -a, a}, {d, d, d, d, d}},
           {{{0, 1.0F}, a, -b, b}, {d, d}},
           {{{1, 1.0F}, b, -a, a}, {d, d, d, d, d}},
           {{{0, -1.0F}, -a, -b, b}, {d, d}}}};
}

class Builder {
 public:
  Builder(std::uint64_t seed, double similarity)
      : furnisher_(rectangles_, seed, similarity), layout_(core::seed_of(seed, "twin.layout", 0)) {}

  std::vector<Rectangle> build() {
    add_floor_and_ceiling();
    for (const auto& wall : walls()) add_wall(wall);
    add_ceiling_things();
    return std::move(rectangles_);
  }

 private:
  void add_floor_and_ceiling() {
    const Material carpet = furnisher_.fresh(Finish::kCarpet, colour_of_srgb(0.40F, 0.44F, 0.50F),
                                             colour_of_srgb(0.72F, 0.68F, 0.56F));
    const Material board = furnisher_.fresh(Finish::kCeiling, colour_of_srgb(0.91F, 0.90F, 0.87F),
                                            colour_of_srgb(0.94F, 0.94F, 0.93F));
    const Eigen::Vector2f outer = kOuter_m;
    const Eigen::Vector2f inner = kInner_m;
    const std::array<std::array<Eigen::Vector2f, 2>, 4> legs = {
        {{Eigen::Vector2f(-outer), Eigen::Vector2f(outer.x(), -inner.y())},
         {Eigen::Vector2f(-outer.x(), inner.y()), outer},
         {Eigen::Vector2f(inner.x(), -inner.y()), Eigen::Vector2f(outer.x(), inner.y())},
         {Eigen::Vector2f(-outer.x(), -inner.y()), Eigen::Vector2f(-inner.x(), inner.y())}}};
    for (const auto& [low, high] : legs) {
      const Eigen::Vector2f size = high - low;
      rectangles_.push_back({.corner_m = {low.x(), low.y(), 0.0F},
                             .right = Eigen::Vector3f::UnitX(),
                             .up = Eigen::Vector3f::UnitY(),
                             .size_m = size,
                             .pattern_m = low,
                             .material = carpet});
      rectangles_.push_back({.corner_m = {low.x(), high.y(), kHeight_m},
                             .right = Eigen::Vector3f::UnitX(),
                             .up = -Eigen::Vector3f::UnitY(),
                             .size_m = size,
                             .pattern_m = low,
                             .material = board});
    }
  }

  void add_wall(const Wall& wall) {
    const WallSide& side = wall.side;
    Eigen::Vector3f low(0.0F, 0.0F, 0.0F);
    Eigen::Vector3f high(0.0F, 0.0F, kHeight_m);
    low[side.face.axis] = high[side.face.axis] = side.plane_m;
    low[1 - side.face.axis] = side.low_m;
    high[1 - side.face.axis] = side.high_m;
    const Material paint = furnisher_.fresh(Finish::kWall, colour_of_srgb(0.86F, 0.84F, 0.78F),
                                            colour_of_srgb(0.66F, 0.70F, 0.70F));
    for (const auto& face : faces_of({low, high}, side.face, {paint, paint})) {
      if (face.size_m.minCoeff() > 0.0F &&
          face.normal()[side.face.axis] * side.face.facing > 0.5F) {
        rectangles_.push_back(face);
      }
    }
    const auto num_bays = static_cast<float>(wall.bays.size());
    const float pitch_m = (side.high_m - side.low_m) / num_bays;
    for (std::size_t i = 0; i < wall.bays.size(); ++i) {
      const float start_m = side.low_m + pitch_m * static_cast<float>(i);
      add_bay({side, start_m + 0.5F * pitch_m}, wall.bays[i], pitch_m);
      const bool is_last = i + 1 == wall.bays.size();
      if (is_last) continue;
      const bool has_room = wall.bays[i] == Bay::kDoor && wall.bays[i + 1] == Bay::kDoor;
      add_decoration({side, start_m + pitch_m}, has_room);
    }
    add_cable_duct(side);
  }

  void add_bay(const Place& place, Bay bay, float pitch_m) {
    constexpr float kHalfDoor_m = 0.52F;
    const float half_gap_m = bay == Bay::kDoor ? kHalfDoor_m : 0.0F;
    const Material rubber = furnisher_.fresh(Finish::kPaint, colour_of_srgb(0.28F, 0.27F, 0.27F),
                                             colour_of_srgb(0.28F, 0.27F, 0.27F));
    for (const float sign : {-1.0F, 1.0F}) {
      const Eigen::Vector2f ends_m(place.along_m + sign * half_gap_m,
                                   place.along_m + sign * 0.5F * pitch_m);
      furnisher_.add_strip(place.side, {ends_m, {0.0F, 0.09F}, {0.0F, 0.012F}}, rubber);
    }
    if (bay == Bay::kDoor) {
      furnisher_.add_door(place, next_room_++);
    } else {
      furnisher_.add_window(place);
    }
  }

  void add_cable_duct(const WallSide& side) {
    const Colour grey = colour_of_srgb(0.80F, 0.80F, 0.78F);
    furnisher_.add_strip(side, {{side.low_m, side.high_m}, {2.38F, 2.43F}, {0.0F, 0.035F}},
                         furnisher_.fresh(Finish::kPaint, grey, grey));
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
      furnisher_.add_exit_sign({sign * 5.4F, sign * y}, {0.03F, 0.5F}, kHeight_m);
      furnisher_.add_exit_sign({sign * x, -sign * 2.4F + 1.2F}, {0.5F, 0.03F}, kHeight_m);
    }
  }

  std::vector<Rectangle> rectangles_;
  Furnisher furnisher_;
  core::Random layout_;  // of its own: what stands where does not depend on similarity
  int next_room_ = kFirstRoom;
};

}  // namespace

std::vector<Rectangle> office_loop_surfaces(std::uint64_t seed, double similarity) {
  return Builder(seed, similarity).build();
}

}  // namespace samewhere::twin
