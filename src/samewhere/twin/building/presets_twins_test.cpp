// Units of a kind look as alike as similarity says.
#include <map>

#include <samewhere/twin/building/test_presets.hpp>
#include <samewhere/twin/render/ray_scene.hpp>

namespace samewhere::twin {
namespace {

// How a unit looks along rays that start at the same points in each of its kin.
struct Glance {
  float distance_m = 0.0F;
  Colour colour = Colour::Zero();
  bool is_inside = false;  // what is seen belongs to the unit
};

class UnitEyes {
 public:
  explicit UnitEyes(const Building& building) : building_(building), rays_(building.rectangles) {}

  // The k-th ray of a unit: its kin get the same in their coordinates.
  Glance glance(int unit, std::uint64_t k) const {
    core::Random random(k);
    std::vector<const Area*> areas;
    for (const auto& area : building_.areas) {
      if (area.unit == unit) areas.push_back(&area);
    }
    const Area& area = *areas[random.index(areas.size())];
    const core::Rigid3& world_from_unit = unit_of(unit).world_from_unit;
    const core::Rigid3 unit_from_world = inverse(world_from_unit);
    const Eigen::Vector3d a = unit_from_world * area.low_m.cast<double>();
    const Eigen::Vector3d b = unit_from_world * area.high_m.cast<double>();
    Eigen::Vector3d origin;
    for (int i = 0; i < 3; ++i) {
      const double ratio = random.uniform(0.1, 0.9);
      origin[i] = std::min(a[i], b[i]) + ratio * std::abs(b[i] - a[i]);
    }
    const Eigen::Vector3d direction = random_direction(random).cast<double>().normalized();
    const Ray ray{(world_from_unit * origin).cast<float>(),
                  (world_from_unit.rotation * direction).cast<float>()};
    const auto hit = rays_.first_hit(ray);
    if (!hit) return {};
    const Eigen::Vector3f seen_m = ray.origin + hit->reach * ray.direction;
    const bool is_inside = std::any_of(areas.begin(), areas.end(), [&](const Area* candidate) {
      return holds(*candidate, seen_m, 0.02F);
    });
    const auto& rectangle = building_.rectangles[static_cast<std::size_t>(hit->rectangle)];
    return {hit->reach, rectangle.material.colour, is_inside};
  }

  const Unit& unit_of(int unit) const { return building_.units[static_cast<std::size_t>(unit)]; }

 private:
  const Building& building_;
  RayScene rays_;
};

struct Likeness {
  double same_distance = 0.0;      // share of rays
  double colour_difference = 0.0;  // mean of the largest channel
};

// Of all units with an elder of their kind.
Likeness likeness_of(const Building& building) {
  const UnitEyes eyes(building);
  std::map<int, int> first_of_kind;
  double num = 0.0;
  Likeness sum;
  for (int unit = 0; unit < static_cast<int>(building.units.size()); ++unit) {
    const auto [first, is_first] = first_of_kind.try_emplace(eyes.unit_of(unit).kind, unit);
    if (is_first) continue;
    for (std::uint64_t k = 0; k < 300; ++k) {
      const Glance a = eyes.glance(first->second, k);
      const Glance b = eyes.glance(unit, k);
      if (!a.is_inside || !b.is_inside) continue;
      num += 1.0;
      sum.same_distance += std::abs(a.distance_m - b.distance_m) < 0.01F ? 1.0 : 0.0;
      sum.colour_difference += static_cast<double>((a.colour - b.colour).abs().maxCoeff());
    }
  }
  return {sum.same_distance / num, sum.colour_difference / num};
}

class PresetWithTwins : public testing::TestWithParam<std::string> {};

TEST_P(PresetWithTwins, TwinsAreBuiltAlikeAndLookAsAlikeAsSimilaritySays) {
  const auto likeness = [&](double similarity) {
    return likeness_of(build_world(spec_of(GetParam(), 3, similarity)).visits[0]);
  };
  const Likeness alike = likeness(1.0);
  EXPECT_GT(alike.same_distance, 0.99);
  EXPECT_LT(alike.colour_difference, 0.02);
  const Likeness usual = likeness(0.8);
  EXPECT_GT(usual.same_distance, 0.8);
  EXPECT_LT(usual.colour_difference, 0.06);
  const Likeness apart = likeness(0.0);
  EXPECT_GT(apart.colour_difference, 2.0 * usual.colour_difference);
  EXPECT_LT(apart.same_distance, usual.same_distance);
}

INSTANTIATE_TEST_SUITE_P(Twins, PresetWithTwins,
                         testing::Values("twin-corridors", "hotel", "no-return", "warehouse",
                                         "mirror", "long-haul"),
                         test_name);

}  // namespace
}  // namespace samewhere::twin
