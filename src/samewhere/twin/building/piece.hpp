#pragma once

#include <cstdint>
#include <string>

#include <samewhere/twin/building/building.hpp>
#include <samewhere/twin/building/shapes.hpp>
#include <samewhere/twin/building/style.hpp>

namespace samewhere::twin {

// Where a piece is put, and in which taste.
struct Site {
  Building& building;
  int unit;
  const Style& style;
  const LightSetting& light;
  const Palette& palette;
  std::uint64_t thing;  // counts the things of the unit
};

enum class Cover : std::uint8_t { kNone, kGlass };

// One thing of a furnished unit while it is made: its shapes, its draws, what it is made of.
class Piece : public Shapes {
 public:
  // `stand_in_unit`: the piece takes it into the world.
  Piece(const Site& site, const Stance& stand_in_unit);

  Draws& draws() { return draws_; }
  const Palette& palette() const { return site_.palette; }
  const LightSetting& light() const { return site_.light; }

  // What follows draws afresh, whatever was drawn before: parts that may be there or not stay in
  // step that way.
  void begin_part(int part);

  // With a pattern as alike as the style says, and wear of its own.
  Material made_of(Finish finish, const Colour& colour, const Colour& second);
  Material made_of(Finish finish, const Colour& colour) { return made_of(finish, colour, colour); }
  // The same by the patterns and the wear that run through the whole unit. `plane` tells planes
  // apart.
  Material running(Finish finish, const Colour& colour, const Colour& second,
                   std::uint32_t plane) const;
  // What follows is this object. Its name gets the unit and the count of the thing unless it is
  // `unique`, when the name says it all.
  void begin_object(const std::string& name, bool is_unique = false);
  void end_object() { set_object(-1); }
  // A sheet of paper, its print one's own with a chance of at least `min_own`: an object, unique
  // then.
  void add_paper(const Box& sheet, double min_own, Cover cover = Cover::kNone);
  // A frame of this width around a box, as deep as the box.
  void add_frame(const Box& around, float width_m, const Material& material);

 private:
  Site site_;
  Draws draws_;
};

// In the plane of a wall: middle, size, and from where to where it stands out.
Box centred(const Eigen::Vector2f& middle_m, const Eigen::Vector2f& size_m,
            const Eigen::Vector2f& out_m);

// Gamma-coded colours of the usual materials.
namespace paints {
extern const Colour kGrey, kWhite, kBlack, kMetal, kRed, kGreen, kCork, kDaylight, kLampWhite,
    kRubber, kCarton, kPalletWood, kOrange, kBlue;
}

// A colour of any hue, somewhat greyed; both in [0, 1).
Colour hue_colour(double hue, double lightness);

}  // namespace samewhere::twin
