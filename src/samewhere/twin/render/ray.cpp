#include <samewhere/twin/render/ray.hpp>

namespace samewhere::twin {

float reach_of_plane(const Ray& ray, const Rectangle& rectangle) {
  const Eigen::Vector3f normal = rectangle.normal();
  return normal.dot(rectangle.corner_m - ray.origin) / normal.dot(ray.direction);
}

std::optional<float> reach_of(const Ray& ray, const Rectangle& rectangle) {
  const float reach = reach_of_plane(ray, rectangle);
  if (!(reach > kMinReach)) return std::nullopt;
  const Eigen::Array2f at = rectangle.right_up_m(ray.origin + reach * ray.direction);
  const bool is_inside = (at >= 0.0F).all() && (at <= rectangle.size_m.array()).all();
  return is_inside ? std::optional(reach) : std::nullopt;
}

}  // namespace samewhere::twin
