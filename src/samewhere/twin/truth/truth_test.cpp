
#include <gtest/gtest.h>

#include <samewhere/core/random.hpp>
#include <samewhere/twin/building/angles.hpp>
#include <samewhere/twin/building/test_rooms.hpp>
#include <samewhere/twin/front/camera.hpp>
#include <samewhere/twin/front/twin.hpp>
#include <samewhere/twin/truth/truth.hpp>

namespace samewhere::twin {
namespace {

using core::PlaceTruth;
using test::kCamera;
using test::looking;

constexpr double kSecondRoom_m = test::kRoomLength_m + 0.1;

// One frame a second.
Walk walk_of(const std::vector<core::Rigid3>& poses) {
  Walk walk;
  for (const auto& pose : poses) {
    walk.poses.push_back({static_cast<double>(walk.poses.size()), pose});
    walk.visit_of_frame.push_back(0);
  }
  return walk;
}

WalkTruth truth_in(const Building& building, const Walk& walk) {
  const RayScene rays(building.rectangles);
  return truth_of(walk, {{&building, &rays}}, kCamera);
}

// The same view from the first room and from the second.
Walk walk_through_twin_rooms() {
  return walk_of({looking({1.0, 1.2, 1.5}, 0.1), looking({1.1 + kSecondRoom_m, 1.2, 1.5}, 0.1)});
}

TEST(AliasedPairs, AreTwinRoomsSeenAlike) {
  const WalkTruth truth = truth_in(test::twin_rooms(0.0F), walk_through_twin_rooms());
  EXPECT_EQ(truth.places->at(1, 0), PlaceTruth::kDifferent);
  EXPECT_TRUE(truth.loops.empty());
  ASSERT_EQ(truth.aliased_pairs.size(), 1U);
  EXPECT_EQ(truth.aliased_pairs[0].query, 1);
  EXPECT_EQ(truth.aliased_pairs[0].match, 0);
  EXPECT_GT(truth.aliased_pairs[0].alike, 0.85);
  EXPECT_EQ(core_truth({}, truth).aliased_pairs, (std::vector<core::FramePair>{{1, 0}}));
}

TEST(AliasedPairs, AreNoneWhereEveryRoomIsDecoratedDifferently) {
  EXPECT_TRUE(truth_in(test::twin_rooms(1.0F), walk_through_twin_rooms()).aliased_pairs.empty());
  EXPECT_EQ(truth_in(test::twin_rooms(0.5F), walk_through_twin_rooms()).aliased_pairs.size(), 1U);
  EXPECT_TRUE(truth_in(test::twin_rooms(0.51F), walk_through_twin_rooms()).aliased_pairs.empty());

  Building other_kind = test::twin_rooms(0.0F);
  other_kind.units[1].kind = 1;
  EXPECT_TRUE(truth_in(other_kind, walk_through_twin_rooms()).aliased_pairs.empty());
  Building other_walls = test::twin_rooms(0.0F);
  for (std::size_t i = 0; i < 6; ++i) other_walls.rectangles[i].material.pattern_seed += 50;
  EXPECT_TRUE(truth_in(other_walls, walk_through_twin_rooms()).aliased_pairs.empty());
}

TEST(AliasedPairs, NeedTheSameViewOfTheTwin) {
  const auto num_with_second_turned_to = [](double heading_rad) {
    const Walk walk = walk_of(
        {looking({2.0, 1.5, 1.5}, 0.0), looking({2.0 + kSecondRoom_m, 1.5, 1.5}, heading_rad)});
    return truth_in(test::twin_rooms(0.0F), walk).aliased_pairs.size();
  };
  EXPECT_EQ(num_with_second_turned_to(0.3), 1U);
  EXPECT_EQ(num_with_second_turned_to(0.9), 0U) << "more than 45 degrees";
  EXPECT_EQ(num_with_second_turned_to(kPi), 0U);
}

TEST(AliasedPairs, FollowATwinThatIsTurnedRound) {
  Building building;
  test::add_room(building, {}, 0.0F);
  test::add_room(building, test::turned_and_moved(kPi, {10.0, 3.0, 0.0}), 0.0F);
  const core::Rigid3 in_first = looking({1.0, 1.2, 1.5}, 0.2);
  const core::Rigid3 its_twin = building.units[1].world_from_unit * in_first;
  EXPECT_EQ(truth_in(building, walk_of({in_first, its_twin})).aliased_pairs.size(), 1U);
  // seen in the same direction of the world, it is the other end of the room
  const core::Rigid3 unturned = looking(its_twin.translation, 0.2);
  EXPECT_TRUE(truth_in(building, walk_of({in_first, unturned})).aliased_pairs.empty());
}

// A corridor of bays along x, each 3 m long and a unit of its own, all of one kind.
Building row_of_bays(int count) {
  constexpr float kBay_m = 3.0F;
  Building building;
  for (int bay = 0; bay < count; ++bay) {
    building.units.push_back(
        {.kind = 4, .world_from_unit = test::turned_and_moved(0.0, {kBay_m * bay, 0, 0})});
    const auto sides = test::inside_of({kBay_m, 2.0F, 2.6F});
    for (std::size_t i = 2; i < sides.size(); ++i) test::add(building, bay, sides[i]);
    const auto low_x = kBay_m * static_cast<float>(bay);
    building.areas.push_back({.name = "corridor",
                              .unit = bay,
                              .low_m = {low_x, 0, 0},
                              .high_m = {low_x + kBay_m, 2.0F, 2.6F}});
  }
  return building;
}

TEST(AliasedPairs, InARowOfBaysAreWhatIsOutOfSight) {
  const auto aliased_pairs_of = [](const core::Rigid3& first, const core::Rigid3& second) {
    return truth_in(row_of_bays(8), walk_of({first, second})).aliased_pairs;
  };
  const core::Rigid3 in_second_bay = looking({5.9, 0.5, 1.3}, 0.5 * kPi);
  EXPECT_EQ(aliased_pairs_of(in_second_bay, looking({17.9, 0.5, 1.3}, 0.5 * kPi)).size(), 1U);
  // from the beginning of a bay to the end of another: the bay after that one is the best kin
  const auto across_a_border =
      aliased_pairs_of(in_second_bay, looking({12.1, 0.5, 1.3}, 0.5 * kPi));
  ASSERT_EQ(across_a_border.size(), 1U);
  EXPECT_GT(across_a_border[0].alike, 0.8);
  // half a bay off, nothing repeats enough
  EXPECT_TRUE(aliased_pairs_of(in_second_bay, looking({16.4, 0.1, 1.3}, 0.5 * kPi)).empty());
  // the next bay shows some of the same wall: near, not different
  EXPECT_TRUE(
      aliased_pairs_of(looking({4.0, 0.1, 1.3}, 0.2), looking({7.0, 0.1, 1.3}, 0.2)).empty());
}

Walk twice_after(const core::Rigid3& pose, double seconds) {
  Walk walk = walk_of({pose, pose});
  walk.poses[1].stamp_s = seconds;
  return walk;
}

TEST(Loops, AreReturnsAfterTenSeconds) {
  const Building building = test::twin_rooms(0.0F);
  const core::Rigid3 pose = looking({1.0, 1.5, 1.3}, 0.0);
  EXPECT_TRUE(truth_in(building, twice_after(pose, 9.9)).loops.empty());
  const WalkTruth truth = truth_in(building, twice_after(pose, 150.0 / 15.0));
  ASSERT_EQ(truth.loops.size(), 1U);
  EXPECT_EQ(truth.loops[0].query, 1);
  EXPECT_EQ(truth.loops[0].match, 0);
  EXPECT_GT(truth.loops[0].overlap, 0.99);
  EXPECT_FALSE(truth.loops[0].is_confirmable) << "nothing tells this room from its twin";
  EXPECT_EQ(truth.loops[0].object, "");
}

TEST(Loops, CanBeConfirmedByAUniqueThingThatBothViewsShow) {
  Building building = test::twin_rooms(0.0F);
  test::add_plate(building, 0, "door plate 1", 0.2F);
  const core::Rigid3 pose = looking({1.0, 1.5, 1.3}, 0.0);
  const WalkTruth truth = truth_in(building, twice_after(pose, 20.0));
  ASSERT_EQ(truth.loops.size(), 1U);
  EXPECT_TRUE(truth.loops[0].is_confirmable);
  EXPECT_EQ(truth.loops[0].object, "door plate 1");

  // turned by 0.35 rad both still show the plate, but share less than half of what they see
  Walk turned = twice_after(looking({1.0, 1.5, 1.3}, 0.35), 20.0);
  turned.poses[0].world_from_camera = looking({1.0, 1.5, 1.3}, -0.25);
  const WalkTruth half = truth_in(building, turned);
  ASSERT_EQ(half.loops.size(), 1U);
  EXPECT_LT(half.loops[0].overlap, 0.5);
  EXPECT_FALSE(half.loops[0].is_confirmable);
  EXPECT_EQ(half.loops[0].object, "door plate 1");
}

TEST(Revisits, AreStaysInAKnownPlaceThatCanBeConfirmedSomewhere) {
  const auto loop = [](int query, bool is_confirmable) {
    return TrueLoop{.query = query, .match = 0, .overlap = 0.6, .is_confirmable = is_confirmable};
  };
  EXPECT_EQ(revisits_of({}), std::vector<core::FrameSpan>{});
  EXPECT_EQ(revisits_of({loop(20, false), loop(21, false)}), std::vector<core::FrameSpan>{});
  // the second match of frame 21 tells; 24 begins another stay, in which nothing does
  EXPECT_EQ(revisits_of({loop(20, false), loop(21, false), loop(21, true), loop(22, false),
                         loop(24, false), loop(30, true), loop(31, true)}),
            (std::vector<core::FrameSpan>{{20, 22}, {30, 31}}));
}

TEST(Frames, AreInTheAreaThatHoldsThemOrTheNearest) {
  const WalkTruth truth =
      truth_in(test::twin_rooms(0.0F),
               walk_of({looking({1, 1, 1}, 0), looking({7, 1, 1}, 0), looking({4.06, 1, 1}, 0)}));
  EXPECT_EQ(truth.frames[0].room, "room 0");
  EXPECT_EQ(truth.frames[0].floor, 0);
  EXPECT_EQ(truth.frames[1].room, "room 1");
  EXPECT_EQ(truth.frames[1].floor, 1);
  EXPECT_EQ(truth.frames[1].unit, 1);
  EXPECT_EQ(truth.frames[2].room, "room 1") << "inside the wall, nearer to the second";
}

TEST(Frames, OfNoAreaHaveNoUnit) {
  Building building = test::twin_rooms(0.0F);
  building.areas.clear();
  const WalkTruth truth = truth_in(building, walk_through_twin_rooms());
  EXPECT_EQ(truth.frames[1].room, "");
  EXPECT_EQ(truth.frames[1].unit, -1);
  EXPECT_TRUE(truth.aliased_pairs.empty());
}

TEST(SecondVisit, IsTheSamePlaceAfterTheDark) {
  const Building first = test::twin_rooms(0.0F);
  Building second = first;
  test::add_plate(second, 0, "new poster", 1.0F);
  const RayScene rays_of_first(first.rectangles);
  const RayScene rays_of_second(second.rectangles);
  const core::Rigid3 pose = looking({1.0, 1.5, 1.3}, 0.0);
  Walk walk = walk_of({pose, pose, pose, looking({1.0 + kSecondRoom_m, 1.5, 1.3}, 0.0)});
  walk.visit_of_frame = {0, kDark, 1, 1};
  for (auto& stamped : walk.poses) stamped.stamp_s *= 30.0;
  const WalkTruth truth =
      truth_of(walk, {{&first, &rays_of_first}, {&second, &rays_of_second}}, kCamera);

  EXPECT_EQ(truth.frames[1].visit, kDark);
  EXPECT_EQ(truth.frames[1].room, "room 0");
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(truth.places->at(1, i), PlaceTruth::kDifferent) << i;
    EXPECT_EQ(truth.overlap[static_cast<std::size_t>(4 + i)], 0) << i;
  }
  ASSERT_EQ(truth.loops.size(), 1U);
  EXPECT_EQ(truth.loops[0].query, 2);
  EXPECT_EQ(truth.loops[0].match, 0);
  EXPECT_FALSE(truth.loops[0].is_confirmable) << "the poster was not there before";
  // the second room looks like the first of either visit; the poster hides little of it
  EXPECT_EQ(core_truth({}, truth).aliased_pairs, (std::vector<core::FramePair>{{3, 0}, {3, 2}}));
}

std::vector<core::Rigid3> random_poses(core::Random& random, int count) {
  std::vector<core::Rigid3> poses;
  for (int i = 0; i < count; ++i) {
    const double room_m = random.index(2) == 0 ? 0.0 : kSecondRoom_m;
    poses.push_back(looking(
        {room_m + random.uniform(0.3, 3.7), random.uniform(0.3, 2.7), random.uniform(1.0, 2.0)},
        random.uniform(-kPi, kPi)));
  }
  return poses;
}

void expect_no_contradiction(const WalkTruth& truth) {
  const int n = truth.places->num_frames;
  for (int i = 0; i < n; ++i) {
    EXPECT_EQ(truth.places->at(i, i), PlaceTruth::kSame);
    for (int k = 0; k < i; ++k) ASSERT_EQ(truth.places->at(i, k), truth.places->at(k, i));
  }
  for (const TrueLoop& loop : truth.loops) {
    ASSERT_EQ(truth.places->at(loop.query, loop.match), PlaceTruth::kSame);
  }
  for (const AliasedPair& pair : truth.aliased_pairs) {
    ASSERT_GT(pair.query, pair.match);
    ASSERT_GE(pair.alike, 0.3);
    ASSERT_EQ(truth.places->at(pair.query, pair.match), PlaceTruth::kDifferent);
    for (const auto& [row, column] :
         {std::pair(pair.query, pair.match), std::pair(pair.match, pair.query)}) {
      ASSERT_LT(truth.overlap[static_cast<std::size_t>(row * n + column)], 13);  // 5 %
    }
  }
}

TEST(WalkTruth, IsFreeOfContradictionsAndTheSameBackwards) {
  constexpr int kNumFrames = 60;
  const Building building = test::twin_rooms(0.2F);
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    core::Random random(seed);
    std::vector<core::Rigid3> poses = random_poses(random, kNumFrames);
    const WalkTruth forwards = truth_in(building, walk_of(poses));
    std::reverse(poses.begin(), poses.end());
    const WalkTruth backwards = truth_in(building, walk_of(poses));
    expect_no_contradiction(forwards);
    EXPECT_GT(forwards.aliased_pairs.size(), 20U);

    std::vector<core::FramePair> reversed;
    for (const AliasedPair& pair : backwards.aliased_pairs) {
      reversed.push_back({kNumFrames - 1 - pair.match, kNumFrames - 1 - pair.query});
    }
    std::sort(reversed.begin(), reversed.end());
    EXPECT_EQ(core_truth({}, forwards).aliased_pairs, reversed);
    EXPECT_EQ(core_truth({}, forwards).places->values.size(), std::size_t{kNumFrames} * kNumFrames);
  }
}

TEST(WalkTruth, OfALongWalkIsToldForEveryFifteenthFrame) {
  Walk walk;
  for (int i = 0; i <= kMaxFramesOfMatrix; ++i) {
    const double room_m = i < 500 ? 0.0 : kSecondRoom_m;
    walk.poses.push_back({i / 15.0, looking({room_m + 1.0, 1.5, 1.5}, i / 200.0)});
    walk.visit_of_frame.push_back(0);
  }
  const WalkTruth truth = truth_in(test::twin_rooms(0.0F), walk);
  EXPECT_EQ(truth.stride_frames, 15);
  EXPECT_EQ(truth.frames.size(), walk.poses.size());
  EXPECT_TRUE(truth.overlap.empty());
  EXPECT_FALSE(core_truth({}, truth).places);
  ASSERT_FALSE(truth.loops.empty());
  ASSERT_FALSE(truth.aliased_pairs.empty());
  for (const TrueLoop& loop : truth.loops) {
    ASSERT_EQ(loop.query % 15, 0);
    ASSERT_EQ(loop.match % 15, 0);
    ASSERT_GE(loop.query - loop.match, 150);
  }
  for (const AliasedPair& pair : truth.aliased_pairs) {
    ASSERT_EQ(pair.query % 15, 0);
    ASSERT_GE(pair.query, 500);
    ASSERT_LT(pair.match, 500);
  }
}

TEST(OfficeLoop, ReturnsToItsStartAndHasNoLoopBefore) {
  const auto source = open_twin("twin:office-loop?seed=3", {});
  const auto places = *source->truth().places;
  const auto has_loop = [&](int query) {
    for (int match = 0; match < query - 150; ++match) {
      if (places.at(query, match) == PlaceTruth::kSame) return true;
    }
    return false;
  };
  for (int i = 0; i < places.num_frames; ++i) {
    ASSERT_EQ(places.at(i, i), PlaceTruth::kSame) << i;
    ASSERT_EQ(places.at(i, std::max(0, i - 1)), PlaceTruth::kSame) << i;
  }
  for (int i = places.num_frames - 60; i < places.num_frames; ++i) EXPECT_TRUE(has_loop(i)) << i;
  for (int i = 0; i < places.num_frames / 2; ++i) EXPECT_FALSE(has_loop(i)) << i;
}

}  // namespace
}  // namespace samewhere::twin
