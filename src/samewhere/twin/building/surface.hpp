#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace samewhere::twin {

// Linear light, order blue green red.
using Colour = Eigen::Array3f;

// From the usual gamma-coded values in [0, 1].
Colour colour_of_srgb(float red, float green, float blue);

enum class Finish : std::uint8_t {
  kWall,        // painted blocks with a darker dado
  kCarpet,      // tiles
  kCeiling,     // mineral fibre tiles
  kWood,        // door leaves, table tops, frames of boards
  kPaint,       // painted metal
  kSteel,       // brushed metal
  kPlate,       // room number
  kCork,        //
  kPaper,       // posters and notices
  kSign,        // plain pictogram, which one: `number`
  kLamp,        // emits light
  kBlinds,      // a window with its blinds down, emits light
  kGrille,      // slots: vents, radiators
  kPlaster,     // walls painted with a roller
  kBrick,       // painted over
  kConcrete,    // cast between boards; floors too
  kFloorTiles,  // 30 cm
  kPlanks,      // a wooden floor
  kFabric,      // cloth: plain, stripes or checks by `number`
  kPlastic,     // moulded: shells of chairs, switches, bins
  kLeaf,        // of a plant, its rib along `up`
  kSoil,        //
  kSkin,        //
  kHair,        // its strands along `up`
  kCarton,      // corrugated board with tape
  kLabel,       // bar code and small print
  kView,        // a window with what is outside, emits light
  kBooks,       // their backs side by side
  kBigNumber,   // `number` as high as the rectangle
  kCeilingPlaster,
};

// Of Finish::kLamp, Material::number.
enum class LampFace : std::uint8_t { kRibbed, kOpal, kLouvre, kTubes, kRound };

// What hangs before a window: of Finish::kBlinds, Material::number, which counts on through
// kNumSlatWidths for each.
enum class Dressing : std::uint8_t { kBroad, kFine, kUpright, kCurtain, kShade, kCount };
inline constexpr int kNumDressings = static_cast<int>(Dressing::kCount);
inline constexpr int kNumSlatWidths = 4;

// Of Finish::kCeiling, Material::number; one more is plastered.
inline constexpr int kNumCeilingTiles = 5;
inline constexpr int kPlasteredCeiling = kNumCeilingTiles;

// What a surface is made of. Every finish reads the part that it needs.
struct Material {
  Finish finish = Finish::kPaint;
  Colour colour = Colour::Constant(0.5F);
  Colour second = Colour::Constant(0.5F);
  std::uint32_t wear_seed = 0;         // stains, scratches: never the same twice
  std::uint32_t pattern_seed = 0;      // grain, print: the same on look-alikes
  std::uint32_t own_pattern_seed = 0;  // mixed in by own_ratio
  float own_ratio = 0.0F;
  int number = 0;               // of the room, the floor, the pictogram, the kind of cloth
  float radiance = 0.0F;        // of emitting finishes
  float gloss = 0.0F;           // share of what a polished surface would mirror; 0: matt
  float roughness_rad = 0.0F;   // half the angle over which a glossy surface blurs what it mirrors
  std::uint32_t blot_seed = 0;  // a big stain or scratch in the middle; 0: none
};

// A rectangle seen from one side. Metres; the world's z is up.
struct Rectangle {
  Eigen::Vector3f corner_m = Eigen::Vector3f::Zero();  // lower left, as seen
  Eigen::Vector3f right = Eigen::Vector3f::UnitX();    // unit length
  Eigen::Vector3f up = Eigen::Vector3f::UnitY();       // unit length, at right angles to `right`
  Eigen::Vector2f size_m = Eigen::Vector2f::Ones();
  // Added to what lies right of and above the corner, for patterns that run on from one rectangle
  // to the next. On walls its y is the height of the corner above the floor.
  Eigen::Vector2f pattern_m = Eigen::Vector2f::Zero();
  int object = -1;  // index in Building::objects; -1: belongs to none
  // A facet of something round: by how much the normal turns outwards, towards its left and its
  // right side. Light on things that move is computed for the round thing.
  Eigen::Vector2f turns_rad = Eigen::Vector2f::Zero();
  Material material;

  // Towards the observer.
  Eigen::Vector3f normal() const { return right.cross(up); }
  // `right_up_m`: right of and above the corner.
  Eigen::Vector3f at(const Eigen::Vector2f& right_up_m) const {
    return corner_m + right_up_m.x() * right + right_up_m.y() * up;
  }
  Eigen::Vector2f right_up_m(const Eigen::Vector3f& point) const {
    return {right.dot(point - corner_m), up.dot(point - corner_m)};
  }
};

// Corners of a block in the coordinates of the thing that it is a part of.
struct Box {
  Eigen::Vector3f low_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f high_m = Eigen::Vector3f::Zero();
};

}  // namespace samewhere::twin
