#include <cmath>

#include <samewhere/twin/building/angles.hpp>
#include <samewhere/twin/building/shapes.hpp>

namespace samewhere::twin {
namespace {

// Any direction at right angles to a unit vector.
Eigen::Vector3f across(const Eigen::Vector3f& along) {
  const Eigen::Vector3f other =
      std::abs(along.y()) < 0.9F ? Eigen::Vector3f::UnitY() : Eigen::Vector3f::UnitZ();
  return along.cross(other).normalized();
}

}  // namespace

Stance stand_of(const Eigen::Vector3f& origin_m, const Eigen::Vector3f& right,
                const Eigen::Vector3f& up) {
  Stance stand{.origin_m = origin_m};
  stand.axes << right, up, right.cross(up);
  return stand;
}

void Shapes::add_panel(const Panel& panel, const Material& material) {
  rectangles_.push_back({.corner_m = stand_.at(panel.corner_m),
                         .right = stand_.axes * panel.right,
                         .up = stand_.axes * panel.up,
                         .size_m = panel.size_m,
                         .pattern_m = panel.pattern_m.value_or(Eigen::Vector2f(
                             panel.right.dot(panel.corner_m), panel.up.dot(panel.corner_m))),
                         .object = object_,
                         .turns_rad = panel.turns_rad,
                         .material = material});
}

void Shapes::add_face(const Box& box, int axis, float facing, const Material& material) {
  const Eigen::Vector3f normal = facing * Eigen::Vector3f::Unit(axis);
  // upright faces: up is up; level ones: right is right
  Panel face;
  face.right = axis == 1 ? Eigen::Vector3f(Eigen::Vector3f::UnitX())
                         : Eigen::Vector3f(Eigen::Vector3f::UnitY().cross(normal));
  face.up = normal.cross(face.right);
  const Eigen::Vector3f size_m = box.high_m - box.low_m;
  face.size_m = {std::abs(face.right.dot(size_m)), std::abs(face.up.dot(size_m))};
  face.corner_m = 0.5F * (box.low_m + box.high_m) + 0.5F * std::abs(normal.dot(size_m)) * normal -
                  0.5F * face.size_m.x() * face.right - 0.5F * face.size_m.y() * face.up;
  add_panel(face, material);
}

void Shapes::add_box(const Box& box, const Cladding& cladding) {
  add_face(box, 2, 1.0F, cladding.front);
  for (const int axis : {0, 1}) {
    for (const float facing : {-1.0F, 1.0F}) add_face(box, axis, facing, cladding.sides);
  }
}

void Shapes::add_block(const Box& box, const Material& material) {
  add_box(box, {material, material});
  add_face(box, 2, -1.0F, material);
}

void Shapes::add_bar(const Bar& bar, const Material& material) {
  const Eigen::Vector3f along = (bar.to_m - bar.from_m).normalized();
  const Eigen::Vector3f side = across(along);
  const Eigen::Vector3f other = along.cross(side);
  const float half_rad = kPi_f / static_cast<float>(bar.num_sides);
  // as far out as a circle of the same girth, to within a hair
  const float side_m = 2.0F * bar.radius_m * std::tan(half_rad);
  for (int i = 0; i < bar.num_sides; ++i) {
    const float angle_rad = 2.0F * half_rad * static_cast<float>(i);
    const Eigen::Vector3f normal = std::cos(angle_rad) * side + std::sin(angle_rad) * other;
    const Eigen::Vector3f right = along.cross(normal);
    Panel panel{.right = right, .up = along};
    panel.corner_m = bar.from_m + bar.radius_m * normal - 0.5F * side_m * right;
    panel.size_m = {side_m, (bar.to_m - bar.from_m).norm()};
    panel.pattern_m = {side_m * static_cast<float>(i), along.dot(panel.corner_m)};
    panel.turns_rad.fill(half_rad);
    add_panel(panel, material);
  }
  if (!bar.has_ends) return;
  add_end(bar, along, side, material);
  add_end({.from_m = bar.to_m,
           .to_m = bar.from_m,
           .radius_m = bar.radius_m,
           .num_sides = bar.num_sides},
          -along, side, material);
}

// The end at `from_m`: strips between opposite sides together cover the polygon; each lies a hair
// deeper than the one before, so that it is clear which one is seen.
void Shapes::add_end(const Bar& bar, const Eigen::Vector3f& along, const Eigen::Vector3f& side,
                     const Material& material) {
  constexpr float kHair_m = 2e-5F;
  const Eigen::Vector3f normal = -along;
  const Eigen::Vector3f other = along.cross(side);
  const float half_rad = kPi_f / static_cast<float>(bar.num_sides);
  const float side_m = 2.0F * bar.radius_m * std::tan(half_rad);
  for (int i = 0; i < bar.num_sides / 2; ++i) {
    const float angle_rad = 2.0F * half_rad * static_cast<float>(i);
    const Eigen::Vector3f right = std::cos(angle_rad) * side + std::sin(angle_rad) * other;
    const Eigen::Vector3f up = normal.cross(right);
    const Eigen::Vector3f middle_m = bar.from_m + kHair_m * static_cast<float>(i) * along;
    add_panel({.corner_m = middle_m - bar.radius_m * right - 0.5F * side_m * up,
               .right = right,
               .up = up,
               .size_m = {2.0F * bar.radius_m, side_m}},
              material);
  }
}

void Shapes::add_post(const Post& post, const Material& material) {
  constexpr float kSidePattern_m = 0.1F;  // whatever the girth: stripes run on to the post above
  const float half_rad = kPi_f / static_cast<float>(post.num_sides);
  // from the middle to a corner and along its normal, before the ellipse stretches them
  const auto out = [&](int corner) -> Eigen::Array2f {
    const float angle_rad = half_rad * static_cast<float>(2 * corner - 1);
    return {std::sin(angle_rad), std::cos(angle_rad)};
  };
  const auto corner_m = [&](int corner) -> Eigen::Vector3f {
    const Eigen::Array2f xz_m =
        post.middle_m.array() + out(corner) * post.half_m.array() / std::cos(half_rad);
    return {xz_m.x(), post.low_m, xz_m.y()};
  };
  for (int i = 0; i < post.num_sides; ++i) {
    const Eigen::Vector3f side_m = corner_m(i + 1) - corner_m(i);
    const Eigen::Vector3f right = side_m.normalized();
    const auto turn_rad = [&](int corner) {
      const Eigen::Vector2f normal = (out(corner) / post.half_m.array()).matrix().normalized();
      return std::asin(std::abs(right.x() * normal.x() + right.z() * normal.y()));
    };
    add_panel({.corner_m = corner_m(i),
               .right = right,
               .size_m = {side_m.norm(), post.high_m - post.low_m},
               .pattern_m = Eigen::Vector2f(
                   kSidePattern_m * static_cast<float>(i) - 0.5F * side_m.norm(), post.low_m),
               .turns_rad = {turn_rad(i), turn_rad(i + 1)}},
              material);
  }
  if (post.has_lid) add_lid(post, material);
}

// Strips that leave hardly a gap, each a hair below the one before.
void Shapes::add_lid(const Post& post, const Material& material) {
  constexpr float kHair_m = 2e-4F;
  constexpr int kNumStrips = 5;
  for (int i = 0; i < kNumStrips; ++i) {
    const float angle_rad = (15.0F + 15.0F * static_cast<float>(i)) * kPi_f / 180.0F;
    const Eigen::Vector2f half_m =
        post.half_m.cwiseProduct(Eigen::Vector2f(std::cos(angle_rad), std::sin(angle_rad)));
    const Eigen::Vector2f middle_m = post.middle_m;
    add_panel(
        {.corner_m = {middle_m.x() - half_m.x(), post.high_m - kHair_m * static_cast<float>(i),
                      middle_m.y() + half_m.y()},
         .up = -Eigen::Vector3f::UnitZ(),
         .size_m = 2.0F * half_m},
        material);
  }
}

void Shapes::add_sheet(const Panel& panel, const Material& material) {
  constexpr float kThickness_m = 1e-3F;
  add_panel(panel, material);
  Panel back = panel;
  back.corner_m += panel.size_m.x() * panel.right - kThickness_m * panel.right.cross(panel.up);
  back.right = -panel.right;
  add_panel(back, material);
}

}  // namespace samewhere::twin
