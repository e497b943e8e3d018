#include <cmath>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/twin/motion/people.hpp>
#include <samewhere/twin/render/ray_scene.hpp>

namespace samewhere::twin {
namespace {

const std::vector<Eigen::Vector3d> kPath_m = {{0, 0, 0}, {8, 0, 0}, {8, 6, 0}};

TEST(People, WalkAtAWalkingPaceOnTheRightSideOfTheirPath) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Person person({{0, 0, 0}, {20, 0, 0}}, seed);
    for (double stamp_s = 0.0; stamp_s < 60.0; stamp_s += 0.5) {
      const Eigen::Vector3d before = person.position_m(stamp_s - 0.1);
      const Eigen::Vector3d here = person.position_m(stamp_s);
      const Eigen::Vector3d step = person.position_m(stamp_s + 0.1) - before;
      EXPECT_LT(step.norm(), 0.2 * 1.4) << "seed " << seed;
      if (here.x() < 1.5 || here.x() > 18.5) continue;  // turning round
      EXPECT_GT(step.norm(), 0.2 * 0.9) << "seed " << seed;
      EXPECT_NEAR(here.y(), step.x() > 0.0 ? -0.42 : 0.42, 1e-3) << "seed " << seed;
    }
  }
}

TEST(People, StandOnTheFloorUprightAndOfAHumanSize) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Person person(kPath_m, seed);
    for (double stamp_s = 0.0; stamp_s < 10.0; stamp_s += 0.37) {
      Eigen::AlignedBox3f bounds;
      for (const auto& r : person.at(stamp_s)) {
        EXPECT_NEAR(r.right.norm(), 1.0F, 1e-4F);
        EXPECT_NEAR(r.up.norm(), 1.0F, 1e-4F);
        EXPECT_NEAR(r.right.dot(r.up), 0.0F, 1e-4F);
        bounds.extend(r.corner_m).extend(r.at(r.size_m));
      }
      EXPECT_GT(bounds.min().z(), -0.08F) << "seed " << seed << " at " << stamp_s;
      EXPECT_LT(bounds.min().z(), 0.10F) << "seed " << seed << " at " << stamp_s;
      EXPECT_GT(bounds.max().z(), 1.5F);
      EXPECT_LT(bounds.max().z(), 1.95F);
      EXPECT_LT(bounds.sizes().head<2>().maxCoeff(), 1.2F);
      const Eigen::Vector2f middle = person.position_m(stamp_s).head<2>().cast<float>();
      EXPECT_LT((bounds.center().head<2>() - middle).norm(), 0.3F);
    }
  }
}

// Surfaces look outwards: from outside only fronts are visible.
TEST(People, AreClosedSurfaces) {
  const Person person(kPath_m, 3);
  const auto rectangles = person.at(4.0);
  const RayScene rays(rectangles);
  const Eigen::Vector3f feet = person.position_m(4.0).cast<float>();
  int num_fronts = 0;
  int num_backs = 0;
  for (int turn = 0; turn < 16; ++turn) {
    const float angle_rad = 0.4F * static_cast<float>(turn);
    const Eigen::Vector3f away(std::cos(angle_rad), std::sin(angle_rad), 0.0F);
    for (float height_m = 0.1F; height_m < 1.7F; height_m += 0.05F) {
      const Eigen::Vector3f target = feet + height_m * Eigen::Vector3f::UnitZ();
      const auto hit = rays.first_hit({target + 3.0F * away, -away});
      if (!hit) continue;
      const auto& r = rectangles[static_cast<std::size_t>(hit->rectangle)];
      ++(r.normal().dot(away) > 0.0F ? num_fronts : num_backs);
    }
  }
  EXPECT_GT(num_fronts, 300);
  EXPECT_LT(num_backs, 0.02 * num_fronts);
}

TEST(People, LookDifferentAndAreTheSameAgain) {
  const auto people = people_on({kPath_m}, 3, 9);
  const auto again = people_on({kPath_m}, 3, 9);
  ASSERT_EQ(people.size(), 3U);
  for (std::size_t i = 0; i < people.size(); ++i) {
    const auto one = people[i].at(3.0);
    const auto two = again[i].at(3.0);
    ASSERT_EQ(one.size(), two.size());
    for (std::size_t k = 0; k < one.size(); ++k) EXPECT_EQ(one[k].corner_m, two[k].corner_m);
  }
  EXPECT_GT((people[0].position_m(0.0) - people[1].position_m(0.0)).norm(), 0.1);
  EXPECT_NE(people[0].at(0.0)[0].material.pattern_seed, people[1].at(0.0)[0].material.pattern_seed);
  EXPECT_EQ(rectangles_of(people, 3.0).size(),
            people[0].at(3.0).size() + people[1].at(3.0).size() + people[2].at(3.0).size());
}

TEST(People, NeedAPath) { EXPECT_THROW(people_on({}, 1, 9), core::ContractError); }

}  // namespace
}  // namespace samewhere::twin
