#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <set>
#include <sstream>
#include <tuple>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/twin/presets.hpp>
#include <samewhere/twin/presets_route.hpp>
#include <samewhere/twin/ray_scene.hpp>

namespace samewhere::twin {
namespace {

Spec spec_of(const std::string& preset, std::uint64_t seed = 3, double similarity = 0.8) {
  return {.preset = preset, .seed = seed, .similarity = similarity};
}

Eigen::Vector3f random_direction(core::Random& random) {
  return Eigen::Vector3d(random.gaussian(), random.gaussian(), random.gaussian()).cast<float>();
}

Eigen::Vector3f random_point(core::Random& random, const Area& area) {
  Eigen::Vector3f point;
  for (int i = 0; i < 3; ++i) {
    point[i] = static_cast<float>(random.uniform(area.low_m[i], area.high_m[i]));
  }
  return point;
}

bool holds(const Area& area, const Eigen::Vector3f& point_m, float margin_m) {
  return (point_m.array() >= area.low_m.array() - margin_m).all() &&
         (point_m.array() <= area.high_m.array() + margin_m).all();
}

// Points of the route at most this far apart.
std::vector<Eigen::Vector3d> points_along(const Route& route, double step_m) {
  const auto corners = points_of(route);
  std::vector<Eigen::Vector3d> points{corners.front()};
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const Eigen::Vector3d way_m = corners[i] - corners[i - 1];
    const auto num_steps = static_cast<int>(std::ceil(way_m.norm() / step_m));
    for (int k = 1; k <= num_steps; ++k) points.push_back(corners[i - 1] + way_m * k / num_steps);
  }
  return points;
}

std::string test_name(const testing::TestParamInfo<std::string>& preset) {
  std::string name = preset.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

class AnyPreset : public testing::TestWithParam<std::string> {};

TEST_P(AnyPreset, NoRayEscapes) {
  for (const double similarity : {0.0, 0.8, 1.0}) {
    const World world = build_world(spec_of(GetParam(), 3, similarity));
    for (const auto& building : world.visits) {
      const RayScene rays(building.rectangles);
      core::Random random(7);
      for (int i = 0; i < 20000; ++i) {
        const Area& area = building.areas[random.index(building.areas.size())];
        const Ray ray{random_point(random, area), random_direction(random)};
        const auto hit = rays.first_hit(ray);
        ASSERT_TRUE(hit) << "ray " << i << " from " << area.name << ' ' << ray.origin.transpose();
        constexpr float kFurthest_m = 80.0F;
        ASSERT_LT(hit->reach * ray.direction.norm(), kFurthest_m) << "ray " << i;
      }
    }
  }
}

// A rectangle of an axis-aligned surface, in its plane.
struct Flat {
  Eigen::Array2f low;
  Eigen::Array2f high;
  int rectangle;
};

// The plane as whole numbers: axis and side, distance in tenths of a millimetre.
using PlaneKey = std::tuple<int, int>;

std::map<PlaneKey, std::vector<Flat>> planes_of(const Building& building) {
  std::map<PlaneKey, std::vector<Flat>> planes;
  for (std::size_t i = 0; i < building.rectangles.size(); ++i) {
    const Rectangle& r = building.rectangles[i];
    const Eigen::Vector3f normal = r.normal();
    int axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    if (std::abs(normal[axis]) < 0.99999F) continue;
    const Eigen::Vector3f opposite = r.at(r.size_m);
    const int across = (axis + 1) % 3;
    const int up = (axis + 2) % 3;
    const Eigen::Array2f a(r.corner_m[across], r.corner_m[up]);
    const Eigen::Array2f b(opposite[across], opposite[up]);
    const int side = normal[axis] > 0.0F ? 1 : 0;
    const auto distance = static_cast<int>(std::lround(1e4F * r.corner_m[axis]));
    planes[{2 * axis + side, distance}].push_back({a.min(b), a.max(b), static_cast<int>(i)});
  }
  return planes;
}

// Where both lie in one place the camera sees the same.
bool is_same_look(const Material& a, const Material& b) {
  return a.finish == b.finish && (a.colour == b.colour).all() && a.wear_seed == b.wear_seed;
}

std::string name_of(const Building& building, const Rectangle& r) {
  return r.object < 0 ? "a surface" : building.objects[static_cast<std::size_t>(r.object)].name;
}

// Says which two of one plane share a place and do not look the same; nothing if they do not.
std::string fight_between(const Building& building, const Flat& first, const Flat& second) {
  constexpr float kSeen_m = 0.02F;
  const Eigen::Array2f common_m = first.high.min(second.high) - first.low.max(second.low);
  if ((common_m < kSeen_m).any()) return {};
  const auto& a = building.rectangles[static_cast<std::size_t>(first.rectangle)];
  const auto& b = building.rectangles[static_cast<std::size_t>(second.rectangle)];
  if (is_same_look(a.material, b.material)) return {};
  std::ostringstream text;
  text << name_of(building, a) << " and " << name_of(building, b) << " share "
       << common_m.transpose() << " m at " << a.corner_m.transpose();
  return text.str();
}

std::string fight_in(const Building& building, std::vector<Flat> flats) {
  std::sort(flats.begin(), flats.end(),
            [](const Flat& a, const Flat& b) { return a.low.x() < b.low.x(); });
  for (std::size_t i = 0; i < flats.size(); ++i) {
    for (std::size_t k = i + 1; k < flats.size(); ++k) {
      if (flats[k].low.x() >= flats[i].high.x()) break;
      std::string fight = fight_between(building, flats[i], flats[k]);
      if (!fight.empty()) return fight;
    }
  }
  return {};
}

TEST_P(AnyPreset, NoTwoSurfacesFightForOnePlace) {
  const World world = build_world(spec_of(GetParam(), 3, 0.5));
  for (const auto& building : world.visits) {
    for (const auto& [plane, flats] : planes_of(building)) {
      ASSERT_EQ(fight_in(building, flats), "");
    }
  }
}

// From a point at a height where one walks to the nearest part of a rectangle, seen from above.
float distance_m(const Eigen::Vector3f& floor_m, const Rectangle& r) {
  constexpr float kAnkle_m = 0.3F;
  constexpr float kHead_m = 1.9F;
  float nearest_m = 1e9F;
  constexpr int kNumSteps = 4;
  for (int i = 0; i <= kNumSteps; ++i) {
    for (int k = 0; k <= kNumSteps; ++k) {
      const Eigen::Vector2f ratio(static_cast<float>(i) / kNumSteps,
                                  static_cast<float>(k) / kNumSteps);
      const Eigen::Vector3f offset_m = r.at(ratio.cwiseProduct(r.size_m)) - floor_m;
      if (offset_m.z() < kAnkle_m || offset_m.z() > kHead_m) continue;
      nearest_m = std::min(nearest_m, offset_m.head<2>().norm());
    }
  }
  return nearest_m;
}

// Whether a rectangle can be within this distance of a point, quickly.
bool may_be_near(const Eigen::Vector3f& floor_m, const Rectangle& r, float margin_m) {
  const Eigen::Vector3f middle_m = r.at(0.5F * r.size_m) - floor_m;
  return middle_m.norm() < 0.5F * r.size_m.norm() + margin_m + 2.0F;
}

// Nothing where it is clear.
std::string obstacle_near(const Building& building, const Eigen::Vector3f& floor_m) {
  constexpr float kClear_m = 0.6F;
  constexpr float kBesideRails_m = 0.5F;
  for (const auto& r : building.rectangles) {
    const bool is_step = r.object < 0 && (r.normal().z() > 0.9F || r.size_m.minCoeff() < 0.3F);
    if (is_step || !may_be_near(floor_m, r, kClear_m)) continue;
    std::string name = name_of(building, r);
    const float least_m = name.starts_with("handrail") ? kBesideRails_m : kClear_m;
    if (distance_m(floor_m, r) < least_m) return name;
  }
  return {};
}

TEST_P(AnyPreset, TheWayKeepsClearOfWallsAndThings) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    for (const double similarity : {0.0, 0.9}) {
      const World world = build_world(spec_of(GetParam(), seed, similarity));
      auto points = points_along(world.route, 0.35);
      constexpr std::size_t kMost = 400;
      if (points.size() > kMost) points.resize(kMost);
      for (const auto& building : world.visits) {
        for (const auto& point : points) {
          ASSERT_EQ(obstacle_near(building, point.cast<float>()), "")
              << "seed " << seed << ", similarity " << similarity << ", at " << point.transpose();
        }
      }
    }
  }
}

TEST_P(AnyPreset, TheWayAndThePeopleStayOnTheFloor) {
  const World world = build_world(spec_of(GetParam()));
  std::vector<Eigen::Vector3d> points = points_along(world.route, 0.2);
  ASSERT_FALSE(world.paths_of_people.empty());
  for (const auto& path : world.paths_of_people) {
    ASSERT_GE(path.points_m.size(), 2U);
    Route route{.start_m = path.points_m.front()};
    walk(route, path.points_m);
    const auto more = points_along(route, 0.2);
    points.insert(points.end(), more.begin(), more.end());
  }
  for (const auto& point : points) {
    // a slope and the steps under it differ by a step at most
    const bool is_held = std::any_of(
        world.visits[0].areas.begin(), world.visits[0].areas.end(), [&](const Area& area) {
          const Eigen::Vector3f p = point.cast<float>() + Eigen::Vector3f(0.0F, 0.0F, 0.2F);
          return holds(area, p, 1e-3F) && std::abs(area.low_m.z() - point.z()) < 0.18;
        });
    ASSERT_TRUE(is_held) << point.transpose();
  }
}

TEST_P(AnyPreset, TakesAsManyFramesAsPromised) {
  constexpr double kFrameRate_hz = 15.0;
  const World world = build_world(spec_of(GetParam()));
  const double num_frames = kFrameRate_hz * estimated_duration_s(world.route);
  const bool is_long = GetParam() == "long-haul";
  EXPECT_GT(num_frames, is_long ? 26500.0 : 400.0);
  EXPECT_LT(num_frames, is_long ? 27500.0 : 900.0);
  Spec fast = spec_of(GetParam());
  fast.speed = 2.0;
  EXPECT_DOUBLE_EQ(build_world(fast).route.speed_m_s, 2.0 * world.route.speed_m_s);
}

TEST_P(AnyPreset, IsTheSameForTheSameSpecAndAnotherForAnotherSeed) {
  const auto look_of = [&](std::uint64_t seed) {
    const World world = build_world(spec_of(GetParam(), seed));
    std::vector<std::uint32_t> look;
    for (const auto& building : world.visits) {
      for (const auto& r : building.rectangles) {
        look.push_back(r.material.wear_seed);
        look.push_back(r.material.pattern_seed);
        look.push_back(static_cast<std::uint32_t>(std::lround(1e4F * r.corner_m.sum())));
      }
    }
    return look;
  };
  EXPECT_EQ(look_of(3), look_of(3));
  EXPECT_NE(look_of(3), look_of(4));
}

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

INSTANTIATE_TEST_SUITE_P(All, AnyPreset,
                         testing::Values("office-loop", "twin-corridors", "hotel", "no-return",
                                         "warehouse", "mirror", "long-haul", "second-visit"),
                         test_name);

TEST(Presets, AnUnknownOneIsNamed) {
  EXPECT_THROW(build_world(spec_of("castle")), core::InputError);
}

TEST(Presets, NoReturnNeverComesWithinSightOfWhereItWas) {
  const World world = build_world(spec_of("no-return"));
  const auto points = points_along(world.route, 0.5);
  for (std::size_t i = 1; i < points.size(); ++i) {
    EXPECT_GE(points[i].x(), points[i - 1].x() - 1e-9) << "always on";
  }
  EXPECT_EQ(
      std::count_if(world.visits[0].objects.begin(), world.visits[0].objects.end(),
                    [](const Object& o) { return o.name.find("plate") != std::string::npos; }),
      40);
}

// A revisit counts from ten seconds on: the end of the walk against a point 2 m before the first
// look.
TEST(Presets, HotelEndsWithALookThatItHadTenSecondsBefore) {
  const World world = build_world(spec_of("hotel"));
  const auto points = points_of(world.route);
  EXPECT_DOUBLE_EQ(points.back().z(), 12.0);
  // around at the end, back, a moment's rest, around before the stair and out again
  Route until_first = world.route;
  until_first.steps.resize(until_first.steps.size() - 5);
  ASSERT_LT((points_of(until_first).back() - points.back()).norm(), 1e-9);
  const double before_s = estimated_duration_s(until_first) - 2.0 / world.route.speed_m_s;
  EXPECT_GT(estimated_duration_s(world.route) - before_s, 10.0);
}

// What two visits of a building have in common, rectangle by rectangle.
struct Changes {
  int num_walls = 0;  // and floors
  int num_changed_walls = 0;
  int num_moved = 0;
  int num_new_papers = 0;
};

Changes changes_between(const Building& before, const Building& after) {
  Changes changes;
  const std::size_t num_both = std::min(before.rectangles.size(), after.rectangles.size());
  for (std::size_t i = 0; i < num_both; ++i) {
    const Rectangle& a = before.rectangles[i];
    const Rectangle& b = after.rectangles[i];
    const Finish finish = a.material.finish;
    const bool is_wall = finish == Finish::kPlaster || finish == Finish::kCarpet;
    const bool is_moved = (a.corner_m - b.corner_m).norm() > 0.1F;
    const bool is_worn_otherwise = a.material.wear_seed != b.material.wear_seed;
    const bool is_paper = finish == Finish::kPaper && b.material.finish == Finish::kPaper;
    const bool is_new = is_paper && a.material.pattern_seed != b.material.pattern_seed;
    changes.num_walls += static_cast<int>(is_wall);
    changes.num_changed_walls += static_cast<int>(is_wall && (is_moved || is_worn_otherwise));
    changes.num_moved += static_cast<int>(is_moved);
    changes.num_new_papers += static_cast<int>(is_new);
  }
  return changes;
}

bool has_lamps_on(const Building& building) {
  return std::any_of(building.rectangles.begin(), building.rectangles.end(),
                     [](const Rectangle& r) {
                       return r.material.finish == Finish::kLamp && r.material.radiance > 1.0F;
                     });
}

// Structure and wear stay, light and what can be moved do not.
TEST_P(AnyPreset, UniqueThingsHaveANameOfTheirOwn) {
  const World world = build_world(spec_of(GetParam(), 1000, 0.8));
  for (const auto& building : world.visits) {
    std::set<std::string> names;
    for (const auto& object : building.objects) {
      if (!object.is_unique) continue;
      EXPECT_TRUE(names.insert(object.name).second) << object.name;
    }
    EXPECT_GT(names.size(), 10U);
  }
}

TEST(Presets, TheSecondVisitFindsTheSameBuildingInAnotherLight) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const World world = build_world(spec_of("second-visit", seed));
    ASSERT_EQ(world.visits.size(), 2U);
    const Building& before = world.visits[0];
    const Building& after = world.visits[1];
    EXPECT_NE(has_lamps_on(before), has_lamps_on(after)) << "seed " << seed;
    const Changes changes = changes_between(before, after);
    EXPECT_GT(changes.num_walls, 30) << "seed " << seed;
    EXPECT_EQ(changes.num_changed_walls, 0) << "seed " << seed;
    EXPECT_GT(changes.num_moved, 50) << "seed " << seed;
    EXPECT_GT(changes.num_new_papers, 5) << "seed " << seed;
    EXPECT_LT(after.rectangles.size(), before.rectangles.size()) << "a plant is gone";
  }
}

TEST(Presets, LongHaulIsBuiltInSecondsAndComesBackAtAllAges) {
  const auto start = std::chrono::steady_clock::now();
  const World world = build_world(spec_of("long-haul"));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_LT(took.count(), 10.0);
  // ages of revisits in steps of the route, by powers of two
  const auto points = points_of(world.route);
  std::array<int, 10> num_of_age{};
  std::array<bool, 3> has_floor{};
  for (std::size_t i = 0; i < points.size(); ++i) {
    has_floor[static_cast<std::size_t>(std::lround(points[i].z() / 3.0))] = true;
    for (std::size_t k = 0; k < i; ++k) {
      if ((points[i] - points[k]).norm() > 0.1) continue;
      ++num_of_age[static_cast<std::size_t>(std::log2(i - k))];
    }
  }
  for (std::size_t age = 2; age < 8; ++age) EXPECT_GT(num_of_age[age], 3) << "age " << age;
  EXPECT_TRUE(has_floor[0] && has_floor[1] && has_floor[2]);
}

}  // namespace
}  // namespace samewhere::twin
