#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include <samewhere/twin/building/furnisher.hpp>
#include <samewhere/twin/building/test_furniture.hpp>
#include <samewhere/twin/render/texture.hpp>
#include <samewhere/twin/truth/sight.hpp>

namespace samewhere::twin {
namespace {

using test::kWall;
using test::texture_of;
using test::twins;

// The first rectangles of a finish and size, one in each unit.
std::array<Rectangle, 2> pair_of(const Building& building, Finish finish,
                                 const Eigen::Vector2f& size_m) {
  std::vector<Rectangle> found;
  for (const auto& r : building.rectangles) {
    const bool is_like = r.material.finish == finish && (r.size_m - size_m).norm() < 1e-3F;
    if (is_like && std::abs(r.normal().z()) < 0.5F) found.push_back(r);
  }
  if (found.empty()) throw std::runtime_error("no such rectangle");
  return {found.front(), found[found.size() / 2]};
}

double correlation(const Eigen::ArrayXf& a, const Eigen::ArrayXf& b) {
  const Eigen::ArrayXf da = a - a.mean();
  const Eigen::ArrayXf db = b - b.mean();
  return (da * db).sum() / std::sqrt((da * da).sum() * (db * db).sum());
}

double likeness(const std::array<Rectangle, 2>& pair, float footprint_m) {
  return correlation(texture_of(pair[0], footprint_m), texture_of(pair[1], footprint_m));
}

const Eigen::Vector2f kLeaf_m(0.90F, 2.05F);
constexpr float kFromThreeMetres_m = 0.006F;

TEST(Twins, StandAtCounterpartsOfEachOther) {
  const Building building = twins(1.0);
  const core::Rigid3& second_from_first = building.units[1].world_from_unit;
  std::array<std::vector<const Rectangle*>, 2> leaves;
  for (const auto& r : building.rectangles) {
    if (r.material.finish != Finish::kWood || (r.size_m - kLeaf_m).norm() > 1e-3F) continue;
    leaves[r.corner_m.x() > 10.0F ? 1 : 0].push_back(&r);
  }
  ASSERT_EQ(leaves[0].size(), 1U);
  ASSERT_EQ(leaves[1].size(), 1U);
  const Eigen::Vector3d expected = second_from_first * leaves[0][0]->corner_m.cast<double>();
  EXPECT_LT((leaves[1][0]->corner_m.cast<double>() - expected).norm(), 1e-4);
}

TEST(Twins, DifferInNumbersPrintAndWearOnlyAtSimilarityOne) {
  const Building building = twins(1.0);
  const auto doors = pair_of(building, Finish::kWood, kLeaf_m);
  EXPECT_EQ((doors[0].material.colour - doors[1].material.colour).abs().maxCoeff(), 0.0F);
  EXPECT_EQ(doors[0].material.pattern_seed, doors[1].material.pattern_seed);
  EXPECT_NE(doors[0].material.wear_seed, doors[1].material.wear_seed);
  EXPECT_GT(likeness(doors, kFromThreeMetres_m), 0.97);
  const auto plates = pair_of(building, Finish::kPlate, {0.17F, 0.15F});
  EXPECT_NE(plates[0].material.number, plates[1].material.number);
}

TEST(Twins, LookNearlyTheSameFromAfarAndWornCloseUpAtNineTenths) {
  const auto doors = pair_of(twins(0.9), Finish::kWood, kLeaf_m);
  EXPECT_GT(likeness(doors, kFromThreeMetres_m), 0.85);
  EXPECT_LT(likeness(doors, 0.0007F), likeness(doors, kFromThreeMetres_m) - 0.02);
}

TEST(Twins, HaveTheirOwnLooksAtSimilarityZero) {
  const auto doors = pair_of(twins(0.0), Finish::kWood, kLeaf_m);
  EXPECT_LT(likeness(doors, kFromThreeMetres_m), 0.3);
}

TEST(Twins, AreMoreAlikeTheMoreSimilar) {
  double last = -1.0;
  for (const double similarity : {0.0, 0.4, 0.7, 1.0}) {
    const double now =
        likeness(pair_of(twins(similarity), Finish::kWood, kLeaf_m), kFromThreeMetres_m);
    EXPECT_GT(now, last) << similarity;
    last = now;
  }
}

TEST(Twins, StayInStepHoweverUnlikeTheyAre) {
  // whatever came out for the things before it: the last thing's common pattern is the same
  for (const double similarity : {0.0, 0.3, 0.9}) {
    const Building building = twins(similarity);
    std::vector<std::uint32_t> seeds;
    for (const auto& r : building.rectangles) {
      if (r.material.finish == Finish::kLamp) seeds.push_back(r.material.pattern_seed);
    }
    ASSERT_EQ(seeds.size(), 4U);
    EXPECT_EQ(seeds[0], seeds[2]) << similarity;
    EXPECT_EQ(seeds[1], seeds[3]) << similarity;
  }
}

TEST(Twins, EveryFinishIsSharedByAsMuchAsTheSimilaritySays) {
  for (int finish = 0; finish <= static_cast<int>(Finish::kBigNumber); ++finish) {
    std::array<Rectangle, 2> pair;
    for (std::uint32_t i = 0; i < 2; ++i) {
      pair[i].size_m = {1.9F, 1.7F};
      pair[i].material = {.finish = static_cast<Finish>(finish),
                          .second = Colour::Constant(0.2F),
                          .wear_seed = 11 + i,
                          .pattern_seed = 5,
                          .own_pattern_seed = 31 + i};
    }
    EXPECT_GT(likeness(pair, kFromThreeMetres_m), 0.8) << "finish " << finish;
  }
}

TEST(Twins, ShareTheirPatternInTheRoomsFinishesByTheOwnRatio) {
  for (const Finish finish : {Finish::kWall, Finish::kCarpet, Finish::kCeiling, Finish::kPlaster,
                              Finish::kConcrete, Finish::kFloorTiles, Finish::kPlanks}) {
    const auto at_ratio = [&](float own_ratio) {
      std::array<Rectangle, 2> pair;
      for (std::uint32_t i = 0; i < 2; ++i) {
        pair[i].size_m = {0.37F, 0.17F};  // within a block or tile
        pair[i].pattern_m = {0.015F, 0.415F};
        pair[i].material = {.finish = finish,
                            .wear_seed = 11 + i,
                            .pattern_seed = 5,
                            .own_pattern_seed = 31 + i,
                            .own_ratio = own_ratio};
      }
      return likeness(pair, 0.003F);
    };
    EXPECT_GT(at_ratio(0.0F), at_ratio(0.5F)) << static_cast<int>(finish);
    EXPECT_GT(at_ratio(0.5F), at_ratio(1.0F) - 0.1) << static_cast<int>(finish);
    EXPECT_GT(at_ratio(0.1F), 0.75) << static_cast<int>(finish);
  }
}

// What look-alikes at a similarity are made of, in so many pairs of them.
struct FabricCount {
  int num_ceilings = 0;  // pairs under ceilings of one kind
  int num_windows = 0;   // pairs with windows of one size and dressing
  int num_doors = 0;     // pairs whose doors have one kind of frame, closer, handle and plate
};

FabricCount same_fabric(double similarity, int num_pairs) {
  FabricCount count;
  for (int pair = 0; pair < num_pairs; ++pair) {
    const auto palette = [&](std::uint64_t own_seed) {
      return Palette({.common_seed = static_cast<std::uint64_t>(pair),
                      .own_seed = own_seed,
                      .similarity = similarity});
    };
    const Palette a = palette(1000 + 2 * static_cast<std::uint64_t>(pair));
    const Palette b = palette(1001 + 2 * static_cast<std::uint64_t>(pair));
    const auto door = [](const DoorDesign& d) {
      return std::tuple(d.frame_m, d.is_mirrored, d.closer, d.handle, d.plate_m);
    };
    count.num_ceilings += a.ceiling_kind == b.ceiling_kind ? 1 : 0;
    const bool is_one_size = a.window.pane_m == b.window.pane_m;
    count.num_windows += is_one_size && a.window.dressing == b.window.dressing ? 1 : 0;
    count.num_doors += door(a.door) == door(b.door) ? 1 : 0;
  }
  return count;
}

TEST(Twins, ShareTheirFabricAtSimilarityOneAndHardlyEverAtZero) {
  constexpr int kNumPairs = 60;
  const FabricCount alike = same_fabric(1.0, kNumPairs);
  EXPECT_EQ(alike.num_ceilings, kNumPairs);
  EXPECT_EQ(alike.num_windows, kNumPairs);
  EXPECT_EQ(alike.num_doors, kNumPairs);
  const FabricCount usual = same_fabric(0.9, kNumPairs);
  EXPECT_GT(usual.num_ceilings, kNumPairs / 2);
  EXPECT_GT(usual.num_doors, kNumPairs / 2);
  const FabricCount apart = same_fabric(0.0, kNumPairs);
  EXPECT_LT(apart.num_ceilings, kNumPairs / 3);
  EXPECT_LT(apart.num_windows, kNumPairs / 6);
  EXPECT_LT(apart.num_doors, kNumPairs / 10);
}

// How alike two things of one kind are to a camera that stands a metre before each.
double alike(const Rectangle& first, const Rectangle& second) {
  Building a{.rectangles = {first}};
  Building b{.rectangles = {second}};
  for (Building* building : {&a, &b}) {
    Rectangle& r = building->rectangles.front();
    const Rectangle wall{.corner_m = {1.0F, 9.0F, -9.0F},
                         .right = -Eigen::Vector3f::UnitY(),
                         .up = Eigen::Vector3f::UnitZ(),
                         .size_m = {18.0F, 18.0F}};
    const Material material = r.material;
    r = wall;
    r.material = material;
  }
  const RayScene rays_a(a.rectangles);
  const RayScene rays_b(b.rectangles);
  const Eye eye(test::kCamera);
  const Sight query = eye.look(test::looking({0, 0, 0}, 0.0), {&a, &rays_a});
  const Sight match = eye.look(test::looking({0, 0, 0}, 0.0), {&b, &rays_b});
  return eye.alike(query, match, query.viewpoint);
}

// What one call of a furnisher puts up, of one finish, at similarity 0.6.
template <class Add>
Rectangle put_up(std::uint64_t common_seed, std::uint64_t own_seed, Finish finish, const Add& add) {
  Building building;
  building.units = {Unit{}};
  Furnisher f(building, 0, {.common_seed = common_seed, .own_seed = own_seed, .similarity = 0.6});
  add(f);
  for (const auto& r : building.rectangles) {
    if (r.material.finish == finish) return r;
  }
  return {};
}

// Twins whose design is one must give aliased pairs, others not.
template <class Add>
void expect_designs_are_told_apart(Finish finish, const Add& add) {
  int num_alike = 0;
  int num_unlike = 0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const Rectangle a = put_up(seed, 100 + seed, finish, add);
    const Rectangle b = put_up(seed, 200 + seed, finish, add);
    if (a.material.finish != finish || b.material.finish != finish) continue;
    const double found = alike(a, b);
    if (a.material.number != b.material.number) {
      EXPECT_EQ(found, 0.0) << "seed " << seed;
      ++num_unlike;
    } else if (found == 1.0) {
      ++num_alike;
    }
  }
  EXPECT_GT(num_alike, 0);
  EXPECT_GT(num_unlike, 0);
}

TEST(Twins, UnderUnlikeCeilingsAreNoAliasedPairs) {
  expect_designs_are_told_apart(Finish::kCeiling, [](Furnisher& f) {
    f.add_ceiling({-4.0F, -2.0F}, {4.0F, 2.0F}, 2.6F, CeilingFinish::kTiles);
  });
}

TEST(Twins, WithUnlikeBlindsAreNoAliasedPairs) {
  expect_designs_are_told_apart(Finish::kBlinds, [](Furnisher& f) {
    f.add_window({kWall, 3.0F}, Daylight::kBlinds);
  });
}

TEST(Papers, AreOwnHereAndThereEvenAtSimilarityOne) {
  Building building;
  building.units = {Unit{}, Unit{}};
  constexpr int kNumBoards = 60;
  for (int unit = 0; unit < 2; ++unit) {
    Furnisher f(
        building, unit,
        {.common_seed = 7, .own_seed = 50 + static_cast<std::uint64_t>(unit), .similarity = 1.0});
    for (int i = 0; i < kNumBoards; ++i) f.add_notice_board({kWall, 3.0F});
  }
  std::set<std::string> own;
  int num_papers = 0;
  for (const auto& object : building.objects) {
    if (!object.name.starts_with("paper")) continue;
    ++num_papers;
    if (object.is_unique) own.insert(object.name);
  }
  const double share = static_cast<double>(own.size()) / num_papers;
  EXPECT_GT(share, 0.04);
  EXPECT_LT(share, 0.11);
}

TEST(Papers, AreNewInPartAtAnotherVisitAndNothingElseIs) {
  const Building first = twins(0.8);
  const Building second = twins(0.8, 1);
  ASSERT_EQ(first.rectangles.size(), second.rectangles.size());
  int num_same = 0;
  int num_new = 0;
  for (std::size_t i = 0; i < first.rectangles.size(); ++i) {
    const Material& before = first.rectangles[i].material;
    const Material& after = second.rectangles[i].material;
    EXPECT_EQ(before.wear_seed, after.wear_seed);
    if (before.pattern_seed == after.pattern_seed) ++num_same;
    if (before.pattern_seed == after.pattern_seed) continue;
    ++num_new;
    EXPECT_EQ(before.finish, Finish::kPaper);
  }
  EXPECT_GT(num_new, 10);
  EXPECT_GT(num_same, num_new);
}

}  // namespace
}  // namespace samewhere::twin
