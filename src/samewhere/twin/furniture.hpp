#pragma once

#include <vector>

#include <samewhere/core/random.hpp>
#include <samewhere/twin/surface.hpp>

namespace samewhere::twin {

// One wall of a corridor: a plane across x or y, seen from the side that it faces.
struct WallSide {
  Face face;
  float plane_m = 0.0F;
  float low_m = 0.0F;  // its ends along the other horizontal axis
  float high_m = 0.0F;
};

// A box on a wall. Lengths in metres; `along` and `up` in the wall's plane, `out` away from it.
struct Mounted {
  Eigen::Vector2f along_m = Eigen::Vector2f::Zero();  // from, to; along_m = 0 is the place it is at
  Eigen::Vector2f up_m = Eigen::Vector2f::Zero();     // above the floor
  Eigen::Vector2f out_m = Eigen::Vector2f::Zero();
};

// Where on a wall something is put.
struct Place {
  WallSide side;
  float along_m = 0.0F;  // world coordinate of its middle along the wall
};

// Puts things into a building. What look-alikes share follows from the seed alone; what is their
// own comes from a generator and counts as much as `similarity` leaves.
class Furnisher {
 public:
  Furnisher(std::vector<Rectangle>& rectangles, std::uint64_t seed, double similarity);

  void add_door(const Place& place, int number);
  void add_notice_board(const Place& place);
  void add_framed_poster(const Place& place);
  void add_extinguisher(const Place& place);
  void add_cabinet(const Place& place);
  void add_switch(const Place& place);
  void add_window(const Place& place);
  // A long box between two coordinates along the wall.
  void add_strip(const WallSide& side, const Mounted& strip, const Material& material);

  void add_ceiling_lamp(const Eigen::Vector2f& middle_m, const Eigen::Vector2f& size_m,
                        float ceiling_m);
  void add_ceiling_vent(const Eigen::Vector2f& middle_m, float ceiling_m);
  void add_exit_sign(const Eigen::Vector2f& middle_m, const Eigen::Vector2f& size_m,
                     float ceiling_m);

  // A material with wear of its own.
  Material fresh(Finish finish, const Colour& colour, const Colour& second);

 private:
  void mount(const Place& place, const Mounted& mounted, const Materials& materials);
  void mount(const Place& place, const Mounted& mounted, const Material& material);
  void mount_frame(const Place& place, const Mounted& around, float width_m,
                   const Material& material);
  void hang(const Box& box, const Materials& materials);
  void add_door_hardware(const Place& place);
  void add_door_extras(const Place& place, int variant);
  void add_paper(const Place& place, const Mounted& sheet, int slot);
  Material door_wood();
  // The common colour with as much of its own as similarity leaves.
  Colour varied(const Colour& common);
  // True for something of its own, with the chance that similarity leaves.
  bool is_own() { return random_.uniform() >= similarity_; }
  std::uint32_t draw_seed() { return static_cast<std::uint32_t>(random_.next()); }
  std::uint32_t common_seed(std::uint64_t what) const;

  std::vector<Rectangle>& rectangles_;
  std::uint64_t seed_;
  double similarity_;
  core::Random random_;
};

}  // namespace samewhere::twin
