#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace samewhere::twin {

// Linear light, order blue green red.
using Colour = Eigen::Array3f;

// From the usual gamma-coded values in [0, 1].
Colour colour_of_srgb(float red, float green, float blue);

enum class Finish : std::uint8_t {
  kWall,     // painted plaster with a darker dado
  kCarpet,   // tiles
  kCeiling,  // mineral fibre tiles
  kWood,     // door leaves, frames of boards
  kPaint,    // painted metal
  kSteel,    // brushed metal
  kPlate,    // room number
  kCork,     //
  kPaper,    // posters and notices
  kSign,     // plain pictogram
  kLamp,     // emits light
  kBlinds,   // a window with its blinds down, emits light
  kGrille,   // slots: vents, radiators
};

// What a surface is made of. Every finish reads the part that it needs.
struct Material {
  Finish finish = Finish::kPaint;
  Colour colour = Colour::Constant(0.5F);
  Colour second = Colour::Constant(0.5F);
  std::uint32_t wear_seed = 0;         // stains, scratches: never the same twice
  std::uint32_t pattern_seed = 0;      // grain, print: the same on look-alikes
  std::uint32_t own_pattern_seed = 0;  // mixed in by own_ratio
  float own_ratio = 0.0F;
  int number = 0;         // of the room
  float radiance = 0.0F;  // of emitting finishes
};

// An axis-aligned rectangle seen from one side. Metres; z is up.
struct Rectangle {
  int axis = 2;  // of its normal: 0 x, 1 y, 2 z
  float plane_m = 0.0F;
  float facing = 1.0F;                              // +1 or -1: which way the normal points
  Eigen::Vector2f low_m = Eigen::Vector2f::Zero();  // in the two other axes, in the order x y z
  Eigen::Vector2f high_m = Eigen::Vector2f::Zero();
  Material material;

  // The two axes of the plane.
  int first_axis() const { return axis == 0 ? 1 : 0; }
  int second_axis() const { return axis == 2 ? 1 : 2; }
  Eigen::Vector2f size_m() const { return high_m - low_m; }
  Eigen::Vector3f normal() const { return facing * Eigen::Vector3f::Unit(axis); }
  Eigen::Vector2f on_plane(const Eigen::Vector3f& point) const {
    return {point[first_axis()], point[second_axis()]};
  }
  Eigen::Vector3f at(const Eigen::Vector2f& on_plane) const;
};

// Coordinates of the texture: for walls from the lower left corner as seen, so that print reads
// from left to right; for floors and ceilings those of the world, so that patterns run on.
Eigen::Vector2f texture_coordinates(const Rectangle& rectangle, const Eigen::Vector2f& on_plane);

struct Box {
  Eigen::Vector3f low_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f high_m = Eigen::Vector3f::Zero();
};

// Which way a surface looks: +1 or -1 along an axis.
struct Face {
  int axis = 2;
  float facing = 1.0F;
};

struct Materials {
  Material front;
  Material sides;
};

// The five faces that are seen of a box that is fixed to something behind it.
std::vector<Rectangle> faces_of(const Box& box, const Face& front, const Materials& materials);

}  // namespace samewhere::twin
