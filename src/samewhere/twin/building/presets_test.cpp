// What all presets promise, and what each does by itself.
#include <array>
#include <chrono>
#include <set>

#include <samewhere/core/errors.hpp>
#include <samewhere/twin/building/test_presets.hpp>

namespace samewhere::twin {
namespace {

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

// Structure and wear stay, light and what can be moved do not.
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
