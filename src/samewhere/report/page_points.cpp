#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <samewhere/report/packed.hpp>
#include <samewhere/report/page_points.hpp>

namespace samewhere::report {
namespace {

constexpr double kShareOutside = 0.005;  // on each side
constexpr float kMargin = 0.25F;         // of the extent
constexpr float kMinExtent_m = 0.01F;
constexpr float kLargest = std::numeric_limits<std::uint16_t>::max();

struct Box {
  Eigen::Vector3f low = Eigen::Vector3f::Zero();
  Eigen::Vector3f extent = Eigen::Vector3f::Constant(kMinExtent_m);

  bool has(const Eigen::Vector3f& point) const {
    return ((point - low).array() >= 0.0F).all() && ((point - low).array() <= extent.array()).all();
  }
};

std::vector<const ColouredPoint*> finite(const std::vector<ColouredPoint>& points) {
  std::vector<const ColouredPoint*> kept;
  for (const ColouredPoint& point : points)
    if (point.in_world.allFinite()) kept.push_back(&point);
  return kept;
}

Box box_of(const std::vector<const ColouredPoint*>& points) {
  Box box;
  if (points.empty()) return box;
  const auto rank = static_cast<std::ptrdiff_t>(kShareOutside * double(points.size()));
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> values;
    for (const ColouredPoint* point : points) values.push_back(point->in_world[axis]);
    std::sort(values.begin(), values.end());
    const float low = values[static_cast<std::size_t>(rank)];
    const float high = values[values.size() - 1 - static_cast<std::size_t>(rank)];
    const float extent = std::max(high - low, kMinExtent_m);
    box.low[axis] = low - kMargin * extent;
    box.extent[axis] = (1.0F + 2.0F * kMargin) * extent;
  }
  return box;
}

}  // namespace

nlohmann::ordered_json page_points(const std::vector<ColouredPoint>& points,
                                   std::size_t max_points) {
  std::vector<const ColouredPoint*> shown = finite(points);
  const Box box = box_of(shown);
  std::erase_if(shown, [&](const ColouredPoint* point) { return !box.has(point->in_world); });
  const std::size_t step = shown.size() / (max_points + 1) + 1;
  std::vector<std::uint16_t> positions;
  std::vector<std::uint8_t> colours;
  for (std::size_t i = 0; i < shown.size(); i += step) {
    const Eigen::Vector3f share = (shown[i]->in_world - box.low).cwiseQuotient(box.extent);
    for (const float value : share)
      positions.push_back(static_cast<std::uint16_t>(std::lround(kLargest * value)));
    colours.insert(colours.end(), shown[i]->rgb.begin(), shown[i]->rgb.end());
  }
  const Eigen::Vector3f size = box.extent / kLargest;
  nlohmann::ordered_json packed_positions = packed(positions, 3);
  packed_positions["low"] = {box.low.x(), box.low.y(), box.low.z()};
  packed_positions["step"] = {size.x(), size.y(), size.z()};
  return {{"num_in_map", points.size()},
          {"positions", std::move(packed_positions)},
          {"colours", packed(colours, 3)}};
}

}  // namespace samewhere::report
