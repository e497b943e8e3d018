#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/twin/building/angles.hpp>
#include <samewhere/twin/motion/motion.hpp>

namespace samewhere::twin {
namespace {

Route route_along(Carrier carrier, const std::vector<Step>& steps) {
  const bool is_robot = carrier == Carrier::kRobot;
  return {.start_m = {0.0, 0.0, 0.0},
          .start_heading_rad = 0.0,
          .steps = steps,
          .carrier = carrier,
          .speed_m_s = is_robot ? 0.8 : 1.3,
          .camera_height_m = is_robot ? 0.6 : 1.5};
}

Step walk_to(double x_m, double y_m, double z_m = 0.0) { return WalkTo{{x_m, y_m, z_m}}; }

// A rectangle of 12 m x 8 m, the middle of a corridor 2 m wide.
Route rectangle(Carrier carrier) {
  return route_along(carrier, {walk_to(12, 0), walk_to(12, 8), walk_to(0, 8), walk_to(0, 0)});
}

// A bit of everything.
Route varied_route(Carrier carrier) {
  return route_along(
      carrier,
      {walk_to(6, 0), walk_to(6, 5), walk_to(10, 6, 1.5), walk_to(12, 6, 1.5), Stand{1.0},
       TurnTo{kPi}, walk_to(12, 2, 1.5), walk_to(12.4, 1.5, 1.5), walk_to(12, 2, 1.5), Darken{2.0},
       TurnTo{-1.0}, walk_to(12, 2, 4.5), walk_to(15, 2, 4.5), walk_to(15, 2.1, 4.5)});
}

Route looking_aside(Route route) {
  route.look_aside_rad = 0.8;
  return route;
}

Eigen::Vector3d forward_of(const core::Rigid3& world_from_body) {
  return world_from_body.rotation * Eigen::Vector3d::UnitZ();
}

double yaw_of(const core::Rigid3& world_from_body) {
  const Eigen::Vector3d forward = forward_of(world_from_body);
  return std::atan2(forward.y(), forward.x());
}

class CarriedCamera : public testing::TestWithParam<Carrier> {};

TEST_P(CarriedCamera, DerivativesAreThoseOfThePose) {
  constexpr double kStep_s = 1e-4;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Motion motion(looking_aside(varied_route(GetParam())), seed);
    for (double t = 0.05; t < motion.duration_s(); t += 0.0317) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", " << t << " s");
      const core::Rigid3 before = motion.world_from_body(t - kStep_s);
      const core::Rigid3 here = motion.world_from_body(t);
      const core::Rigid3 after = motion.world_from_body(t + kStep_s);
      const Eigen::Vector3d velocity_m_s =
          (after.translation - before.translation) / (2.0 * kStep_s);
      const Eigen::Vector3d acceleration_m_s2 =
          (motion.velocity_m_s(t + kStep_s) - motion.velocity_m_s(t - kStep_s)) / (2.0 * kStep_s);
      const Eigen::Vector3d rate_rad_s =
          (core::log_so3(here.rotation.conjugate() * after.rotation) -
           core::log_so3(here.rotation.conjugate() * before.rotation)) /
          (2.0 * kStep_s);
      ASSERT_LT((velocity_m_s - motion.velocity_m_s(t)).norm(), 1e-4);
      ASSERT_LT((acceleration_m_s2 - motion.acceleration_m_s2(t)).norm(), 2e-2);
      ASSERT_LT((rate_rad_s - motion.angular_velocity_rad_s(t)).norm(), 1e-4);
    }
  }
}

// At 1 kHz, for a carrier of at most 1.3 m/s.
void expect_no_jump(const Motion& motion) {
  constexpr double kStep_s = 1e-3;
  Eigen::Vector3d acceleration_m_s2 = motion.acceleration_m_s2(0.0);
  core::Rigid3 pose = motion.world_from_body(0.0);
  for (int k = 1; k * kStep_s <= motion.duration_s(); ++k) {
    const double t = k * kStep_s;
    const core::Rigid3 next = motion.world_from_body(t);
    ASSERT_LT((next.translation - pose.translation).norm(), 1.7 * kStep_s) << t << " s";
    ASSERT_LT(core::angle_rad(pose.rotation.conjugate() * next.rotation),
              95.0 * kDegree_rad * kStep_s)
        << t << " s";
    ASSERT_LT((motion.acceleration_m_s2(t) - acceleration_m_s2).norm(), 0.8) << t << " s";
    ASSERT_LT(motion.acceleration_m_s2(t).norm(), 9.0) << t << " s";
    acceleration_m_s2 = motion.acceleration_m_s2(t);
    pose = next;
  }
}

TEST_P(CarriedCamera, NeverJumps) { expect_no_jump(Motion(varied_route(GetParam()), 5)); }

TEST_P(CarriedCamera, NeverJumpsOnAWayOfManyShortLines) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    core::Random random(core::seed_of(seed, "test.route", 1));
    std::vector<Step> steps;
    double heading_rad = 0.0;
    Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
    for (int i = 0; i < 20; ++i) {
      heading_rad += random.uniform(-2.0, 2.0);
      position_m += random.uniform(0.05, 1.0) *
                    Eigen::Vector3d(std::cos(heading_rad), std::sin(heading_rad), 0.0);
      steps.emplace_back(WalkTo{position_m});
    }
    const Motion motion(route_along(GetParam(), steps), seed);
    ASSERT_NO_FATAL_FAILURE(expect_no_jump(motion));
    const double end_rad = motion.heading_rad(motion.duration_s() + 1.0);
    EXPECT_NEAR(std::remainder(end_rad - heading_rad, 2.0 * kPi), 0.0, 1e-6);
    EXPECT_NEAR((motion.floor_position_m(motion.duration_s() + 1.0) - position_m).norm(), 0.0,
                1e-6);
  }
}

TEST_P(CarriedCamera, StaysClearOfTheWallsOfACorridor) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    for (const auto& pose : Motion(rectangle(GetParam()), seed).frames(15.0)) {
      const Eigen::Vector3d p = pose.world_from_camera.translation - Eigen::Vector3d(6.0, 4.0, 0.0);
      const double to_outside_m = std::min(7.0 - std::abs(p.x()), 5.0 - std::abs(p.y()));
      const double from_block_m = std::max(std::abs(p.x()) - 5.0, std::abs(p.y()) - 3.0);
      ASSERT_GT(to_outside_m, 0.5) << "seed " << seed << ", " << pose.stamp_s << " s";
      ASSERT_GT(from_block_m, 0.5) << "seed " << seed << ", " << pose.stamp_s << " s";
    }
  }
}

double distance_to_segment_m(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                             const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double ratio = std::clamp(along.dot(p - a) / along.squaredNorm(), 0.0, 1.0);
  return (a + ratio * along - p).norm();
}

TEST_P(CarriedCamera, StaysNearTheLinesOfAnyRoute) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    core::Random random(core::seed_of(seed, "test.route", 0));
    std::vector<Step> steps;
    std::vector<Eigen::Vector2d> corners_m = {Eigen::Vector2d::Zero()};
    for (int i = 0; i < 12; ++i) {
      corners_m.emplace_back(random.uniform(-4.0, 4.0), random.uniform(-4.0, 4.0));
      steps.push_back(walk_to(corners_m.back().x(), corners_m.back().y()));
    }
    for (const auto& pose : Motion(route_along(GetParam(), steps), seed).frames(15.0)) {
      double nearest_m = 1e9;
      for (std::size_t i = 1; i < corners_m.size(); ++i) {
        nearest_m =
            std::min(nearest_m, distance_to_segment_m(pose.world_from_camera.translation.head<2>(),
                                                      corners_m[i - 1], corners_m[i]));
      }
      ASSERT_LT(nearest_m, kMostFromRoute_m + 0.03)
          << "seed " << seed << ", " << pose.stamp_s << " s";
    }
  }
}

TEST_P(CarriedCamera, TheSameSeedGivesTheSameBytesAndAnotherDoesNot) {
  const auto first = Motion(varied_route(GetParam()), 7).frames(15.0);
  const auto again = Motion(varied_route(GetParam()), 7).frames(15.0);
  const auto other = Motion(varied_route(GetParam()), 8).frames(15.0);
  ASSERT_EQ(first.size(), again.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    ASSERT_EQ(first[i].world_from_camera.translation, again[i].world_from_camera.translation);
    ASSERT_EQ(first[i].world_from_camera.rotation.coeffs(),
              again[i].world_from_camera.rotation.coeffs());
  }
  EXPECT_GT(
      (first[60].world_from_camera.translation - other[60].world_from_camera.translation).norm(),
      0.01);
}

TEST_P(CarriedCamera, EndsWhereTheRouteEndsAndLooksThere) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Motion motion(rectangle(GetParam()), seed);
    const core::Rigid3 last = motion.world_from_body(motion.duration_s());
    EXPECT_LT(last.translation.head<2>().norm(), 0.02) << "seed " << seed;
    EXPECT_LT(motion.velocity_m_s(motion.duration_s()).norm(), 0.1) << "seed " << seed;
    EXPECT_NEAR(std::remainder(yaw_of(last) + 0.5 * kPi, 2.0 * kPi), 0.0, 0.1) << "seed " << seed;
    EXPECT_NEAR(motion.heading_rad(motion.duration_s()), 1.5 * kPi, 1e-3) << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Carriers, CarriedCamera,
                         testing::Values(Carrier::kWalker, Carrier::kRobot),
                         [](const auto& carrier) {
                           return carrier.param == Carrier::kWalker ? "Walker" : "Robot";
                         });

TEST(Motion, FortyMetresTakeAboutThirtyThreeSeconds) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    EXPECT_NEAR(Motion(rectangle(Carrier::kWalker), seed).duration_s(), 34.0, 3.0)
        << "seed " << seed;
  }
}

TEST(Motion, FramesAreEvenlySpacedFromZeroToTheEnd) {
  const Motion motion(rectangle(Carrier::kWalker), 1);
  const auto frames = motion.frames(15.0);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    EXPECT_DOUBLE_EQ(frames[k].stamp_s, static_cast<double>(k) / 15.0);
  }
  EXPECT_LE(frames.back().stamp_s, motion.duration_s());
  EXPECT_GT(frames.back().stamp_s, motion.duration_s() - 1.0 / 15.0);
}

TEST(Motion, AWalkerIsLevelAndLooksAheadIntoABend) {
  const Route route = route_along(Carrier::kWalker, {walk_to(8, 0), walk_to(8, 8)});
  double mean_lead_rad = 0.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Motion motion(route, seed);
    for (const auto& pose : motion.frames(15.0)) {
      ASSERT_LT((pose.world_from_camera.rotation * Eigen::Vector3d::UnitY()).z(), -0.95);
      ASSERT_NEAR(pose.world_from_camera.translation.z(), 1.5, 0.02);
    }
    double t = 0.0;
    while (motion.heading_rad(t) < 0.25 * kPi) t += 0.01;
    mean_lead_rad += (yaw_of(motion.world_from_body(t)) - motion.heading_rad(t)) / 20.0;
  }
  EXPECT_GT(mean_lead_rad, 0.3);
}

TEST(Motion, LookingAsideShowsTheSameThingsEachTimeOnTheSamePath) {
  Route route = route_along(Carrier::kWalker, {walk_to(12, 0), walk_to(12, 8)});
  const Motion ahead(route, 3);
  route.look_aside_rad = 0.8;
  const Motion aside(route, 3);
  double most_rad = 0.0;
  for (double t = 0.0; t < ahead.duration_s(); t += 0.1) {
    const core::Rigid3 pose = aside.world_from_body(t);
    EXPECT_NEAR((pose.translation - ahead.world_from_body(t).translation).norm(), 0.0, 1e-12);
    const double aside_rad =
        std::remainder(yaw_of(pose) - yaw_of(ahead.world_from_body(t)), 2.0 * kPi);
    most_rad = std::max(most_rad, std::abs(aside_rad));
    const Eigen::Vector3d floor_m = aside.floor_position_m(t);
    const double heading_rad = aside.heading_rad(t);
    const double side = std::cos(heading_rad) + std::sin(heading_rad);
    EXPECT_NEAR(aside_rad, 0.8 * side * std::sin(0.7 * floor_m.x() + 0.55 * floor_m.y()), 1e-9)
        << t;
  }
  EXPECT_GT(most_rad, 0.7);
}

TEST(Motion, LookingAsideShowsTheSameWallOnTheWayBack) {
  Route route = route_along(Carrier::kRobot, {walk_to(12, 0), walk_to(0, 0)});
  route.look_aside_rad = 0.8;
  const Motion motion(route, 3);
  int num_seen[2] = {0, 0};  // there, back
  for (double t = 0.0; t < motion.duration_s(); t += 0.1) {
    const double ahead = std::cos(motion.heading_rad(t));
    const double swing = std::sin(0.7 * motion.floor_position_m(t).x());
    if (std::abs(ahead) < 0.99 || std::abs(swing) < 0.5) continue;
    ++num_seen[ahead > 0.0 ? 0 : 1];
    EXPECT_GT(swing * std::sin(yaw_of(motion.world_from_body(t))), 0.1) << t;
  }
  EXPECT_GT(num_seen[0], 20);
  EXPECT_GT(num_seen[1], 20);
}

TEST(Motion, AWalkerDriftsALittleAndARobotKeepsItsLine) {
  const auto most_aside_m = [](Carrier carrier, std::uint64_t seed) {
    double most_m = 0.0;
    for (const auto& pose : Motion(route_along(carrier, {walk_to(100, 0)}), seed).frames(15.0)) {
      most_m = std::max(most_m, std::abs(pose.world_from_camera.translation.y()));
    }
    return most_m;
  };
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    EXPECT_GT(most_aside_m(Carrier::kWalker, seed), 0.06) << "seed " << seed;
    EXPECT_LT(most_aside_m(Carrier::kWalker, seed), 0.23) << "seed " << seed;
    EXPECT_LT(most_aside_m(Carrier::kRobot, seed), 1e-3) << "seed " << seed;
  }
}

TEST(Motion, OnStairsTheHeightFollowsAndTheCameraLooksAlong) {
  const Route route =
      route_along(Carrier::kWalker, {walk_to(5, 0), walk_to(10, 0, 3.0), walk_to(15, 0, 3.0)});
  double up_rad = 0.0;
  double level_rad = 0.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Motion motion(route, seed);
    double t = 0.0;
    while (motion.floor_position_m(t).x() < 2.5) t += 0.01;
    EXPECT_NEAR(motion.floor_position_m(t).z(), 0.0, 1e-9);
    level_rad += std::asin(forward_of(motion.world_from_body(t)).z()) / 20.0;
    while (motion.floor_position_m(t).x() < 7.5) t += 0.01;
    EXPECT_NEAR(motion.floor_position_m(t).z(), 1.5, 0.02);
    up_rad += std::asin(forward_of(motion.world_from_body(t)).z()) / 20.0;
    while (motion.floor_position_m(t).x() < 12.5) t += 0.01;
    EXPECT_NEAR(motion.floor_position_m(t).z(), 3.0, 1e-9);
  }
  const double slope_rad = std::atan2(3.0, 5.0);
  EXPECT_NEAR(level_rad, -0.06, 0.03);
  EXPECT_NEAR(up_rad - level_rad, 0.5 * slope_rad, 0.05);
}

TEST(Motion, ALiftIsRiddenStandingAndLeftTheWayItWasEntered) {
  const Motion motion(
      route_along(Carrier::kWalker, {walk_to(3, 0), walk_to(3, 0, 9), walk_to(0, 0, 9)}), 2);
  bool has_ridden = false;
  for (double t = 0.0; t < motion.duration_s(); t += 0.01) {
    const Eigen::Vector3d p = motion.floor_position_m(t);
    if (p.z() < 0.1 || p.z() > 8.9) continue;
    has_ridden = true;
    EXPECT_LT((p.head<2>() - Eigen::Vector2d(3, 0)).norm(), 1e-3) << t << " s";
    EXPECT_LT((motion.world_from_body(t).translation - p - Eigen::Vector3d(0, 0, 1.5)).norm(), 1e-3)
        << t << " s";
    EXPECT_NEAR(motion.heading_rad(t), 0.0, 1e-3) << t << " s";
  }
  EXPECT_TRUE(has_ridden);
  EXPECT_NEAR(motion.heading_rad(motion.duration_s()), kPi, 1e-3);
}

TEST(Motion, ATurnOnTheSpotTakesTheShorterWayAndStays) {
  const auto turned_rad = [](double from_rad, double to_rad) {
    Route route = route_along(Carrier::kRobot, {TurnTo{to_rad}});
    route.start_heading_rad = from_rad;
    const Motion motion(route, 1);
    for (const auto& pose : motion.frames(100.0)) {
      EXPECT_LT(pose.world_from_camera.translation.head<2>().norm(), 2e-3);
      EXPECT_LT(motion.angular_velocity_rad_s(pose.stamp_s).norm(), 80.0 * kDegree_rad);
    }
    return motion.heading_rad(motion.duration_s() + 1.0) - from_rad;
  };
  EXPECT_NEAR(turned_rad(0.0, 1.0), 1.0, 1e-9);
  EXPECT_NEAR(turned_rad(0.5 * kPi, -0.4 * kPi), -0.9 * kPi, 1e-9);
  EXPECT_NEAR(turned_rad(3.0, -3.0), 2.0 * kPi - 6.0, 1e-9);
  EXPECT_NEAR(turned_rad(0.0, kPi), kPi, 1e-9);
  EXPECT_NEAR(turned_rad(0.0, -kPi), kPi, 1e-9);
  EXPECT_NEAR(turned_rad(7.0 * kPi, 0.0), kPi, 1e-9);
}

TEST(Motion, AWayBackIsTurnedToOnTheSpot) {
  const Motion motion(route_along(Carrier::kWalker, {walk_to(5, 0), walk_to(0, 0)}), 3);
  double farthest_m = 0.0;
  for (double t = 0.0; t < motion.duration_s(); t += 0.01) {
    farthest_m = std::max(farthest_m, motion.floor_position_m(t).x());
    const Eigen::Vector3d velocity_m_s =
        (motion.floor_position_m(t + 1e-3) - motion.floor_position_m(t)) / 1e-3;
    const double heading_rad = motion.heading_rad(t);
    if (velocity_m_s.norm() > 0.3) {
      EXPECT_GT(velocity_m_s.dot(Eigen::Vector3d(std::cos(heading_rad), std::sin(heading_rad), 0)),
                0.9 * velocity_m_s.norm())
          << t << " s: walks the way it faces";
    }
  }
  EXPECT_NEAR(farthest_m, 5.0, 1e-3);
}

TEST(Motion, EachDarkPeriodSeparatesTwoVisitsAndNothingMovesInIt) {
  const Route route = route_along(Carrier::kRobot, {walk_to(2, 0), Darken{2.0}, walk_to(4, 0),
                                                    Stand{1.0}, Darken{0.5}, walk_to(5, 0)});
  const Motion motion(route, 4);
  int num_dark_ms = 0;
  int visit = 0;
  for (int k = 0; k * 1e-3 <= motion.duration_s(); ++k) {
    const double t = k * 1e-3;
    const std::optional<int> now = motion.visit_at(t);
    if (!now) {
      ++num_dark_ms;
      EXPECT_LT(motion.velocity_m_s(t).norm(), 0.1);
    } else {
      EXPECT_TRUE(*now == visit || *now == visit + 1) << t << " s";
      visit = *now;
    }
  }
  EXPECT_NEAR(num_dark_ms, 2500, 5);
  EXPECT_EQ(visit, 2);
}

TEST(Motion, NothingToDoIsAMotionOfOneFrame) {
  const Motion motion(route_along(Carrier::kWalker, {}), 1);
  EXPECT_EQ(motion.duration_s(), 0.0);
  EXPECT_EQ(motion.frames(15.0).size(), 1U);
  EXPECT_EQ(motion.visit_at(0.0), 0);
}

TEST(Motion, ARouteThatCannotBeWalkedIsRefused) {
  Route route = rectangle(Carrier::kWalker);
  route.speed_m_s = 0.0;
  EXPECT_THROW(Motion(route, 1), core::ContractError);
  EXPECT_THROW(Motion(route_along(Carrier::kWalker, {walk_to(NAN, 0)}), 1), core::ContractError);
  EXPECT_THROW(Motion(route_along(Carrier::kWalker, {Stand{-1.0}}), 1), core::ContractError);
}

}  // namespace
}  // namespace samewhere::twin
