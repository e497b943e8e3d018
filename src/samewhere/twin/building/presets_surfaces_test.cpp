// The surfaces of a preset close every room and do not share a place.
#include <map>
#include <set>
#include <sstream>
#include <tuple>

#include <samewhere/twin/building/test_presets.hpp>
#include <samewhere/twin/render/ray_scene.hpp>

namespace samewhere::twin {
namespace {

Eigen::Vector3f random_point(core::Random& random, const Area& area) {
  Eigen::Vector3f point;
  for (int i = 0; i < 3; ++i) {
    point[i] = static_cast<float>(random.uniform(area.low_m[i], area.high_m[i]));
  }
  return point;
}

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

// Things that hang on walls or stand on floors, a block around each.
struct Thing {
  std::string name;
  Eigen::AlignedBox3f block_m;
};

// Of those that nothing else stands in, on or against. Chairs stand askew: no block fits them.
bool needs_its_own_place(const std::string& name) {
  const std::set<std::string> kinds = {
      "door",      "double door", "lift door", "window",      "notice board", "picture frame",
      "switch",    "sign",        "radiator",  "bin",         "extinguisher", "cabinet",
      "coat rack", "leaflets",    "low shelf", "shelf",       "crates",       "sofa",
      "pallet",    "rack",        "desk",      "floor number"};
  return kinds.count(name.substr(0, name.find_last_of(' '))) > 0;
}

std::vector<Thing> things_of(const Building& building) {
  std::vector<Thing> things;
  for (const auto& object : building.objects) things.push_back({object.name, {}});
  for (const auto& r : building.rectangles) {
    if (r.object < 0) continue;
    auto& block_m = things[static_cast<std::size_t>(r.object)].block_m;
    for (const float u : {0.0F, 1.0F}) {
      for (const float v : {0.0F, 1.0F}) {
        block_m.extend(r.at(Eigen::Vector2f(u * r.size_m.x(), v * r.size_m.y())));
      }
    }
  }
  std::erase_if(things, [](const Thing& thing) { return !needs_its_own_place(thing.name); });
  std::sort(things.begin(), things.end(), [](const Thing& a, const Thing& b) {
    return a.block_m.min().x() < b.block_m.min().x();
  });
  return things;
}

// Says which two things reach into each other; nothing if none do.
std::string meeting_in(const std::vector<Thing>& things) {
  constexpr float kMayTouch_m = 0.004F;
  for (auto a = things.begin(); a != things.end(); ++a) {
    for (auto b = a + 1; b != things.end(); ++b) {
      if (b->block_m.min().x() >= a->block_m.max().x()) break;
      const Eigen::Vector3f common_m = a->block_m.intersection(b->block_m).sizes();
      if ((common_m.array() < kMayTouch_m).any()) continue;
      std::ostringstream text;
      text << a->name << " and " << b->name << " share " << common_m.transpose() << " m at "
           << b->block_m.min().transpose();
      return text.str();
    }
  }
  return {};
}

TEST_P(AnyPreset, ThingsStandBesideEachOther) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const World world = build_world(spec_of(GetParam(), seed, 0.8));
    for (const auto& building : world.visits) {
      ASSERT_EQ(meeting_in(things_of(building)), "") << "seed " << seed;
    }
  }
}

}  // namespace
}  // namespace samewhere::twin
