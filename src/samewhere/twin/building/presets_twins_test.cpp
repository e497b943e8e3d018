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

// Mean over rays of pairs of units, one of each building.
class Comparison {
 public:
  Comparison(const Building& a, const Building& b) : a_(a), b_(b) {}

  void add(int unit_of_a, int unit_of_b) {
    for (std::uint64_t k = 0; k < 300; ++k) {
      const Glance a = a_.glance(unit_of_a, k);
      const Glance b = b_.glance(unit_of_b, k);
      if (!a.is_inside || !b.is_inside) continue;
      num_ += 1.0;
      sum_.same_distance += std::abs(a.distance_m - b.distance_m) < 0.01F ? 1.0 : 0.0;
      sum_.colour_difference += static_cast<double>((a.colour - b.colour).abs().maxCoeff());
    }
  }

  Likeness mean() const { return {sum_.same_distance / num_, sum_.colour_difference / num_}; }

 private:
  UnitEyes a_;
  UnitEyes b_;
  Likeness sum_;
  double num_ = 0.0;
};

// Of all units with an elder of their kind.
Likeness likeness_of(const Building& building) {
  Comparison comparison(building, building);
  std::map<int, int> first_of_kind;
  for (int unit = 0; unit < static_cast<int>(building.units.size()); ++unit) {
    const int kind = building.units[static_cast<std::size_t>(unit)].kind;
    const auto [first, is_first] = first_of_kind.try_emplace(kind, unit);
    if (!is_first) comparison.add(first->second, unit);
  }
  return comparison.mean();
}

// Of each unit with the same of the other building.
Likeness likeness_of(const Building& a, const Building& b) {
  Comparison comparison(a, b);
  for (int unit = 0; unit < static_cast<int>(a.units.size()); ++unit) comparison.add(unit, unit);
  return comparison.mean();
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

TEST_P(PresetWithTwins, AnotherBuildingOfTheSameDesignIsAsAlikeAsTwinsAre) {
  const auto likeness = [&](double similarity) {
    Spec spec = spec_of(GetParam(), 3, similarity);
    const World first = build_world(spec);
    spec.copy = 1;
    return likeness_of(first.visits[0], build_world(spec).visits[0]);
  };
  const Likeness alike = likeness(1.0);
  EXPECT_GT(alike.same_distance, 0.99);
  EXPECT_LT(alike.colour_difference, 0.02);
  const Likeness usual = likeness(0.8);
  EXPECT_LT(usual.colour_difference, 0.06);
  EXPECT_GT(likeness(0.0).colour_difference, 2.0 * usual.colour_difference);
}

INSTANTIATE_TEST_SUITE_P(Twins, PresetWithTwins,
                         testing::Values("twin-corridors", "hotel", "no-return", "warehouse",
                                         "mirror", "long-haul"),
                         test_name);

}  // namespace
}  // namespace samewhere::twin
