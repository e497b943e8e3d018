#include <cmath>

#include <samewhere/twin/surface.hpp>

namespace samewhere::twin {

Colour colour_of_srgb(float red, float green, float blue) {
  return {std::pow(blue, 2.2F), std::pow(green, 2.2F), std::pow(red, 2.2F)};
}

Eigen::Vector3f Rectangle::at(const Eigen::Vector2f& on_plane) const {
  Eigen::Vector3f point;
  point[axis] = plane_m;
  point[first_axis()] = on_plane.x();
  point[second_axis()] = on_plane.y();
  return point;
}

Eigen::Vector2f texture_coordinates(const Rectangle& rectangle, const Eigen::Vector2f& on_plane) {
  if (rectangle.axis == 2) return on_plane;
  // seen from the side that the normal points to, +y is on the right of +x, and -x on the right
  // of +y
  const bool runs_up = (rectangle.axis == 0) == (rectangle.facing > 0.0F);
  const float u =
      runs_up ? on_plane.x() - rectangle.low_m.x() : rectangle.high_m.x() - on_plane.x();
  return {u, on_plane.y() - rectangle.low_m.y()};
}

std::vector<Rectangle> faces_of(const Box& box, const Face& front, const Materials& materials) {
  std::vector<Rectangle> faces;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float facing : {-1.0F, 1.0F}) {
      const bool is_along_front = axis == front.axis;
      if (is_along_front && facing != front.facing) continue;  // the back
      Rectangle face{.axis = axis,
                     .plane_m = facing > 0.0F ? box.high_m[axis] : box.low_m[axis],
                     .facing = facing,
                     .material = is_along_front ? materials.front : materials.sides};
      face.low_m = face.on_plane(box.low_m);
      face.high_m = face.on_plane(box.high_m);
      faces.push_back(face);
    }
  }
  return faces;
}

}  // namespace samewhere::twin
