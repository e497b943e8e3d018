#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/correct/loop_corrector.hpp>

namespace samewhere::correct {
namespace {

// Once round a square of 40 m, each step measured with an error that always turns the same way.
struct Walk {
  scene::MapVersion map;
  std::vector<core::Rigid3> truth;
};

Walk square_walk(double turn_error_rad) {
  Walk walk;
  walk.truth = {core::Rigid3{}};
  scene::Edit edit;
  core::Rigid3 estimate;
  for (int i = 0; i <= 40; ++i) {
    scene::Keyframe keyframe;
    keyframe.id = core::KeyframeId(static_cast<std::uint64_t>(i));
    if (i > 0) {
      const core::Rigid3 step{core::exp_so3({0.0, i % 10 == 0 ? 1.5707963 : 0.0, 0.0}),
                              {0.0, 0.0, 1.0}};
      const core::Rigid3 measured =
          step * core::Rigid3{core::exp_so3({0.0, turn_error_rad, 0.0}), {0, 0, 0}};
      walk.truth.push_back(walk.truth.back() * step);
      estimate = estimate * measured;
      keyframe.odometry = {core::KeyframeId(static_cast<std::uint64_t>(i - 1)), measured,
                           1e4 * core::Matrix6d::Identity()};
    }
    keyframe.world_from_body = estimate;
    edit.keyframes.push_back(keyframe);
  }
  walk.map = apply(scene::MapVersion{}, edit);
  return walk;
}

double worst_error_m(const Walk& walk, const scene::MapVersion& map) {
  double worst = 0.0;
  for (std::size_t i = 0; i < walk.truth.size(); ++i) {
    worst = std::max(
        worst, (map.keyframes[i].world_from_body.translation - walk.truth[i].translation).norm());
  }
  return worst;
}

scene::LoopEdge true_loop(const Walk& walk, int query, int match) {
  scene::LoopEdge loop;
  loop.query = core::KeyframeId(static_cast<std::uint64_t>(query));
  loop.match = core::KeyframeId(static_cast<std::uint64_t>(match));
  loop.match_from_query = inverse(walk.truth[static_cast<std::size_t>(match)]) *
                          walk.truth[static_cast<std::size_t>(query)];
  loop.information = 1e4 * core::Matrix6d::Identity();
  return loop;
}

TEST(CloseLoop, ATrueLoopTakesTheDriftOut) {
  const Walk walk = square_walk(0.01);
  const double before = worst_error_m(walk, walk.map);
  const scene::MapVersion closed =
      apply(walk.map, close_loop(walk.map, true_loop(walk, 40, 0), {}));
  EXPECT_GT(before, 2.0);
  EXPECT_LT(worst_error_m(walk, closed), 0.25 * before);
  EXPECT_EQ(closed.loops.size(), 1U);
  EXPECT_EQ(closed.number, walk.map.number + 1);
}

TEST(CloseLoop, TheFirstKeyframeStays) {
  const Walk walk = square_walk(0.01);
  const scene::MapVersion closed =
      apply(walk.map, close_loop(walk.map, true_loop(walk, 38, 2), {}));
  EXPECT_LT(core::log_r3so3(closed.keyframes[0].world_from_body).norm(), 1e-12);
}

TEST(CloseLoop, EarlierLoopsStillCount) {
  const Walk walk = square_walk(0.01);
  const scene::MapVersion first = apply(walk.map, close_loop(walk.map, true_loop(walk, 40, 0), {}));
  const scene::MapVersion second = apply(first, close_loop(first, true_loop(walk, 39, 1), {}));
  EXPECT_LT(worst_error_m(walk, second), 1.2 * worst_error_m(walk, first));
  EXPECT_EQ(second.loops.size(), 2U);
}

TEST(CloseLoop, ALoopToAKeyframeThatIsNotThereIsABrokenPromise) {
  const Walk walk = square_walk(0.0);
  scene::LoopEdge loop = true_loop(walk, 40, 0);
  loop.query = core::KeyframeId(99);
  EXPECT_THROW(close_loop(walk.map, loop, {}), core::ContractError);
}

}  // namespace
}  // namespace samewhere::correct
