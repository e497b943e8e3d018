#include <samewhere/twin/render/finishes.hpp>
#include <samewhere/twin/render/print.hpp>
#include <samewhere/twin/render/texture.hpp>

namespace samewhere::twin {
namespace {

// Finishes whose pattern runs on from one rectangle to the next.
Colour running_finish(const Material& m, const TexturePoint& p) {
  switch (m.finish) {
    case Finish::kWall:
      return block_wall(m, p);
    case Finish::kPlaster:
      return plaster(m, p);
    case Finish::kCeilingPlaster:
      return ceiling_plaster(m, p);
    case Finish::kBrick:
      return brick_wall(m, p);
    case Finish::kConcrete:
      return concrete(m, p);
    case Finish::kCarpet:
      return carpet(m, p);
    case Finish::kFloorTiles:
      return floor_tiles(m, p);
    case Finish::kPlanks:
      return planks(m, p);
    case Finish::kCeiling:
      return ceiling_tiles(m, p);
    case Finish::kWood:
      return wood(m, p);
    case Finish::kSteel:
      return steel(m, p);
    case Finish::kPlastic:
      return plastic(m, p);
    case Finish::kCork:
      return cork(m, p);
    case Finish::kFabric:
      return fabric(m, p);
    case Finish::kSoil:
      return soil(m, p);
    case Finish::kSkin:
      return skin(m, p);
    case Finish::kHair:
      return hair(m, p);
    default:
      return paint(m, p);
  }
}

}  // namespace

Colour reflectance(const Rectangle& rectangle, const TexturePoint& point) {
  const Material& m = rectangle.material;
  switch (m.finish) {
    case Finish::kPlate:
      return door_plate(rectangle, point);
    case Finish::kPaper:
      return poster(rectangle, point);
    case Finish::kSign:
      return pictogram(rectangle, point);
    case Finish::kLabel:
      return label(rectangle, point);
    case Finish::kBigNumber:
      return big_number(rectangle, point);
    case Finish::kLamp:
      return lamp(rectangle, point);
    case Finish::kBlinds:
      return blinds(rectangle, point);
    case Finish::kView:
      return window_view(rectangle, point);
    case Finish::kGrille:
      return grille(m, point);
    case Finish::kLeaf:
      return leaf(rectangle, point);
    case Finish::kCarton:
      return carton(rectangle, point);
    case Finish::kBooks:
      return books(rectangle, point);
    default:
      break;
  }
  const TexturePoint in_pattern{point.u_m + rectangle.pattern_m.x(),
                                point.v_m + rectangle.pattern_m.y(), point.footprint_m};
  const Colour colour = running_finish(m, in_pattern);
  return m.blot_seed == 0 ? colour : Colour(colour * blotted(rectangle, point));
}

Colour mean_reflectance(const Material& material) {
  switch (material.finish) {
    case Finish::kWall:
    case Finish::kBrick:
      return 0.6F * material.colour + 0.4F * material.second;
    case Finish::kView:
      return 0.55F * material.colour;
    case Finish::kBooks:
      return 0.3F * material.colour;
    default:
      return 0.9F * material.colour;
  }
}

bool is_emitting(const Material& material) { return material.radiance > 0.0F; }

}  // namespace samewhere::twin
