#include <cmath>

#include <samewhere/twin/surface.hpp>

namespace samewhere::twin {

Colour colour_of_srgb(float red, float green, float blue) {
  return {std::pow(blue, 2.2F), std::pow(green, 2.2F), std::pow(red, 2.2F)};
}

namespace {

// The rectangle between two corners of a box that looks along an axis.
Rectangle face_of(const Box& box, const Face& face) {
  const Eigen::Vector3f normal = face.facing * Eigen::Vector3f::Unit(face.axis);
  // walls: up is up; level ones: right is the world's x
  const bool is_level = face.axis == 2;
  const Eigen::Vector3f right =
      is_level ? Eigen::Vector3f::UnitX() : Eigen::Vector3f(Eigen::Vector3f::UnitZ().cross(normal));
  const Eigen::Vector3f up = normal.cross(right);
  const Eigen::Vector3f middle = 0.5F * (box.low_m + box.high_m);
  const Eigen::Vector3f size_m = box.high_m - box.low_m;
  const Eigen::Vector2f on_face(std::abs(right.dot(size_m)), std::abs(up.dot(size_m)));
  Rectangle rectangle{.right = right, .up = up, .size_m = on_face};
  rectangle.corner_m = middle + 0.5F * std::abs(normal.dot(size_m)) * normal -
                       0.5F * on_face.x() * right - 0.5F * on_face.y() * up;
  if (is_level) {
    rectangle.pattern_m = {right.dot(rectangle.corner_m), up.dot(rectangle.corner_m)};
  }
  return rectangle;
}

}  // namespace

std::vector<Rectangle> faces_of(const Box& box, const Face& front, const Materials& materials) {
  std::vector<Rectangle> faces;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float facing : {-1.0F, 1.0F}) {
      const bool is_along_front = axis == front.axis;
      if (is_along_front && facing != front.facing) continue;  // the back
      Rectangle face = face_of(box, {axis, facing});
      face.material = is_along_front ? materials.front : materials.sides;
      faces.push_back(face);
    }
  }
  return faces;
}

}  // namespace samewhere::twin
