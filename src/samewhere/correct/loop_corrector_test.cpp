#include <algorithm>
#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/correct/loop_corrector.hpp>
#include <samewhere/features/test_world.hpp>

namespace samewhere::correct {
namespace {

// One lap of a square of 40 m; each odometry step has the same rotation error.
struct Walk {
  scene::MapVersion map;
  std::vector<core::Rigid3> truth;
};

// With scale drift (a share per step) the camera has no depth.
Walk square_walk(double turn_error_rad, std::optional<double> scale_drift = {}) {
  const features::View view =
      features::test_view(features::test_world(1, 20), 0, core::Rigid3{}, 0.0, !scale_drift);
  Walk walk;
  walk.truth = {core::Rigid3{}};
  scene::Edit edit;
  core::Rigid3 estimate;
  for (int i = 0; i <= 40; ++i) {
    scene::Keyframe keyframe;
    keyframe.id = core::KeyframeId(static_cast<std::uint64_t>(i));
    keyframe.view = view;
    keyframe.slots.resize(static_cast<std::size_t>(view.features->size()));
    if (i > 0) {
      const core::Rigid3 step{core::exp_so3({0.0, i % 10 == 0 ? 1.5707963 : 0.0, 0.0}),
                              {0.0, 0.0, 1.0}};
      core::Rigid3 measured =
          step * core::Rigid3{core::exp_so3({0.0, turn_error_rad, 0.0}), {0, 0, 0}};
      measured.translation *= std::exp(-scale_drift.value_or(0.0) * (i - 1));
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
    const core::Rigid3 pose = world_from_body(map, map.keyframes[i].id);
    worst = std::max(worst, (pose.translation - walk.truth[i].translation).norm());
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
  loop.cause = core::CandidateId(static_cast<std::uint64_t>(100 * query + match));
  return loop;
}

TEST(PoseGraphOf, HasAnOdometryEdgePerKeyframeAndALoopEdgePerLoop) {
  const Walk walk = square_walk(0.002);
  scene::MapVersion map = apply(walk.map, close_loop(walk.map, true_loop(walk, 38, 2), {}).edit);
  map = apply(map, close_loop(map, true_loop(walk, 40, 0), {}).edit);
  const optimize::PoseGraph graph = pose_graph_of(map, {});
  ASSERT_EQ(graph.world_from_node.size(), 41U);
  ASSERT_EQ(graph.edges.size(), 42U);
  for (int i = 1; i <= 40; ++i) {
    const optimize::PoseEdge& edge = graph.edges[static_cast<std::size_t>(i - 1)];
    EXPECT_EQ(edge.a, i - 1);
    EXPECT_EQ(edge.b, i);
    EXPECT_FALSE(edge.is_loop);
  }
  EXPECT_TRUE(graph.edges[40].is_loop);
  EXPECT_EQ(graph.edges[40].a, 2);
  EXPECT_EQ(graph.edges[40].b, 38);
  EXPECT_EQ(graph.edges[41].a, 0);
  EXPECT_EQ(graph.edges[41].b, 40);
}

TEST(CloseLoop, ATrueLoopCorrectsTheDrift) {
  const Walk walk = square_walk(0.01);
  const double before = worst_error_m(walk, walk.map);
  const scene::MapVersion closed =
      apply(walk.map, close_loop(walk.map, true_loop(walk, 40, 0), {}).edit);
  EXPECT_GT(before, 2.0);
  EXPECT_LT(worst_error_m(walk, closed), 0.25 * before);
  EXPECT_EQ(closed.loops.size(), 1U);
  EXPECT_EQ(closed.number, walk.map.number + 1);
}

TEST(CloseLoop, WithoutDepthItCorrectsTheScaleDrift) {
  constexpr double kScaleDrift = 0.005;
  Walk walk = square_walk(0.002, kScaleDrift);
  scene::Edit seen;
  scene::Landmark landmark;
  landmark.id = core::LandmarkId(0);
  landmark.anchor = core::KeyframeId(40);
  landmark.position_in_anchor = {0.0, 0.0, std::exp(-40 * kScaleDrift)};  // in truth 1 m ahead
  seen.landmarks = {landmark};
  walk.map = apply(std::move(walk.map), seen);

  scene::LoopEdge loop = true_loop(walk, 40, 0);
  loop.log_scale = 40 * kScaleDrift;
  const Closing closing = close_loop(walk.map, loop, {});
  ASSERT_EQ(closing.accepted.size(), 1U);
  const scene::MapVersion corrected = apply(walk.map, closing.edit);
  EXPECT_LT(worst_error_m(walk, corrected), 0.3 * worst_error_m(walk, walk.map));
  EXPECT_NEAR(corrected.landmarks[0].position_in_anchor.z(), 1.0, 0.1);
  EXPECT_NEAR(corrected.loops[0].log_scale, 0.0, 0.1) << "both ends are of one scale now";

  // solved again, nothing moves
  const scene::MapVersion again = apply(corrected, solve_poses(corrected, {}));
  EXPECT_LT((again.keyframes[20].world_from_body.translation -
             corrected.keyframes[20].world_from_body.translation)
                .norm(),
            1e-3);
  // without the loop, the scale drift is back
  const scene::MapVersion without = apply(corrected, withdraw_loop(corrected, loop.cause, {}));
  EXPECT_LT((without.keyframes[20].world_from_body.translation -
             walk.map.keyframes[20].world_from_body.translation)
                .norm(),
            1e-2);
  EXPECT_NEAR(without.landmarks[0].position_in_anchor.z(), std::exp(-40 * kScaleDrift), 1e-3);
}

TEST(CloseLoop, TheFirstKeyframeStays) {
  const Walk walk = square_walk(0.01);
  const scene::MapVersion closed =
      apply(walk.map, close_loop(walk.map, true_loop(walk, 38, 2), {}).edit);
  EXPECT_LT(core::log_r3so3(closed.keyframes[0].world_from_body).norm(), 1e-12);
}

TEST(CloseLoop, EarlierLoopsStayInTheGraph) {
  const Walk walk = square_walk(0.01);
  const scene::MapVersion first =
      apply(walk.map, close_loop(walk.map, true_loop(walk, 40, 0), {}).edit);
  const scene::MapVersion second = apply(first, close_loop(first, true_loop(walk, 39, 1), {}).edit);
  EXPECT_LT(worst_error_m(walk, second), 1.2 * worst_error_m(walk, first));
  EXPECT_EQ(second.loops.size(), 2U);
}

// A false loop closure: the query is off by `shift_m` along the world's x.
scene::LoopEdge false_loop(const Walk& walk, int query, int match, double shift_m) {
  scene::LoopEdge loop = true_loop(walk, query, match);
  const core::Rigid3 shift{Eigen::Quaterniond::Identity(), {shift_m, 0.0, 0.0}};
  const auto at = [&](int i) { return walk.truth[static_cast<std::size_t>(i)]; };
  loop.match_from_query = inverse(at(match)) * shift * at(query);
  loop.cause = core::CandidateId(9000U + static_cast<std::uint64_t>(query));
  return loop;
}

double rms_error_m(const Walk& walk, const scene::MapVersion& map) {
  double sum = 0.0;
  for (std::size_t i = 0; i < walk.truth.size(); ++i)
    sum += (map.keyframes[i].world_from_body.translation - walk.truth[i].translation).squaredNorm();
  return std::sqrt(sum / static_cast<double>(walk.truth.size()));
}

bool has_loop(const std::vector<scene::LoopEdge>& loops, core::CandidateId cause) {
  return std::any_of(loops.begin(), loops.end(),
                     [&](const scene::LoopEdge& loop) { return loop.cause == cause; });
}

TEST(CloseLoop, AFalseLoopAmongTrueOnesIsRejectedAndMovesNothing) {
  const Walk walk = square_walk(0.002);
  scene::MapVersion map = walk.map;
  for (const int query : {38, 39, 40})
    map = apply(map, close_loop(map, true_loop(walk, query, 40 - query), {}).edit);
  const Closing closing = close_loop(map, false_loop(walk, 37, 3, 2.0), {});
  ASSERT_TRUE(closing.rejected);
  EXPECT_GT(closing.rejected->chi2, optimize::Config{}.loop_chi2);
  EXPECT_TRUE(closing.accepted.empty() && closing.withdrawn.empty());
  EXPECT_TRUE(closing.edit.pose_changes.empty() && closing.edit.loops.empty());
  const scene::MapVersion after = apply(map, closing.edit);
  EXPECT_EQ(after.loops.size(), 3U);
  EXPECT_TRUE(has_loop(after.suspended_loops, closing.rejected->loop.cause));
}

// The false loop comes first: it is within the drift of odometry.
TEST(CloseLoop, AFalseLoopIsWithdrawnWhenLaterOnesContradictIt) {
  const Walk walk = square_walk(0.002);
  const scene::LoopEdge wrong = false_loop(walk, 36, 3, 0.8);
  const Closing first = close_loop(walk.map, wrong, {});
  ASSERT_FALSE(first.rejected) << "the test needs an accepted false loop";
  scene::MapVersion map = apply(walk.map, first.edit);
  scene::MapVersion never = walk.map;
  bool is_withdrawn = false;
  for (const int query : {37, 38, 39, 40}) {
    const scene::LoopEdge loop = true_loop(walk, query, 40 - query);
    const Closing closing = close_loop(map, loop, {});
    for (const auto& outlier : closing.withdrawn) {
      EXPECT_EQ(outlier.loop.cause, wrong.cause);
      EXPECT_GT(outlier.chi2, optimize::Config{}.loop_chi2);
      is_withdrawn = true;
    }
    map = apply(map, closing.edit);
    never = apply(never, close_loop(never, loop, {}).edit);
  }
  EXPECT_TRUE(is_withdrawn);
  EXPECT_FALSE(has_loop(map.loops, wrong.cause));
  EXPECT_TRUE(has_loop(map.suspended_loops, wrong.cause));
  EXPECT_EQ(map.loops.size(), 4U) << "true loops that it contradicted are accepted again";
  EXPECT_LT(rms_error_m(walk, map), 1.02 * rms_error_m(walk, never));
  EXPECT_GT(rms_error_m(walk, apply(walk.map, first.edit)), 2.0 * rms_error_m(walk, never));
}

// The square with a true loop and `num_false` consistent false ones, all accepted.
scene::MapVersion with_false_loops(const Walk& walk, int num_false) {
  scene::MapVersion map = apply(walk.map, close_loop(walk.map, true_loop(walk, 24, 3), {}).edit);
  for (int i = 0; i < num_false; ++i) {
    const Closing closing = close_loop(map, false_loop(walk, 34 + i, 4, 0.8), {});
    EXPECT_FALSE(closing.rejected) << "the test needs accepted false loops";
    map = apply(map, closing.edit);
  }
  return map;
}

TEST(CloseLoop, OverruledLoopsAreNotInTheGraph) {
  const Walk walk = square_walk(0.002);
  const scene::MapVersion map = with_false_loops(walk, 3);
  const scene::LoopEdge loop = true_loop(walk, 39, 1);
  EXPECT_TRUE(close_loop(map, loop, {}).rejected) << "one against three";

  const Closing closing = close_loop(map, loop, {}, false_loop(walk, 34, 4, 0.8).cause);
  EXPECT_FALSE(closing.rejected);
  EXPECT_EQ(closing.withdrawn.size(), 3U);
  const scene::MapVersion after = apply(map, closing.edit);
  EXPECT_EQ(after.loops.size(), 2U) << "the true one before them, and the new one";
  EXPECT_TRUE(after.suspended_loops.empty()) << "they would be tested again with the next loop";
  EXPECT_LT(worst_error_m(walk, after), 0.5 * worst_error_m(walk, map));
}

TEST(CloseLoop, ALoopAcceptedAfterAnOverruledOneStaysIfItFits) {
  const Walk walk = square_walk(0.002);
  scene::MapVersion map = with_false_loops(walk, 1);
  scene::Edit edit;  // accepted since, and true
  edit.loops = {true_loop(walk, 36, 34)};
  map = apply(map, edit);
  const Closing closing =
      close_loop(map, true_loop(walk, 39, 1), {}, false_loop(walk, 34, 4, 0.8).cause);
  ASSERT_EQ(closing.withdrawn.size(), 1U);
  const scene::MapVersion after = apply(map, closing.edit);
  EXPECT_TRUE(has_loop(after.loops, true_loop(walk, 36, 34).cause));
  EXPECT_EQ(after.loops.size(), 3U);
}

TEST(CloseLoop, AnOverrulingLoopThatDoesNotFitTheOthersChangesNothing) {
  const Walk walk = square_walk(0.002);
  scene::MapVersion map = with_false_loops(walk, 1);
  scene::Edit edit;  // a suspended loop that the graph would accept
  edit.suspended_loops = {true_loop(walk, 23, 4)};
  map = apply(map, edit);
  const Closing closing =
      close_loop(map, false_loop(walk, 25, 3, 2.0), {}, false_loop(walk, 34, 4, 0.8).cause);
  EXPECT_TRUE(closing.rejected && closing.withdrawn.empty() && closing.accepted.empty());
  const scene::MapVersion after = apply(map, closing.edit);
  EXPECT_EQ(after.loops.size(), map.loops.size());
  EXPECT_EQ(after.suspended_loops.size(), 2U);
  EXPECT_LT(std::abs(worst_error_m(walk, after) - worst_error_m(walk, map)), 1e-12);
}

TEST(CloseLoop, ALoopThatIsNotInTheMapCannotBeOverruled) {
  const Walk walk = square_walk(0.002);
  const scene::LoopEdge loop = true_loop(walk, 40, 0);
  const Closing plain = close_loop(walk.map, loop, {});
  const Closing closing = close_loop(walk.map, loop, {}, core::CandidateId(12345));
  EXPECT_EQ(closing.accepted.size(), 1U);
  EXPECT_EQ(rms_error_m(walk, apply(walk.map, closing.edit)),
            rms_error_m(walk, apply(walk.map, plain.edit)));
}

TEST(WithdrawLoop, WithdrawsAnyLoopInAnyOrder) {
  const Walk walk = square_walk(0.01);
  const scene::LoopEdge first = true_loop(walk, 38, 2);
  const scene::LoopEdge second = true_loop(walk, 40, 0);
  scene::MapVersion both = apply(walk.map, close_loop(walk.map, first, {}).edit);
  both = apply(both, close_loop(both, second, {}).edit);
  const scene::MapVersion after = apply(both, withdraw_loop(both, first.cause, {}));
  const scene::MapVersion never = apply(walk.map, close_loop(walk.map, second, {}).edit);
  ASSERT_EQ(after.loops.size(), 1U);
  EXPECT_EQ(after.loops[0].cause, second.cause);
  EXPECT_TRUE(after.suspended_loops.empty()) << "withdrawn by the user, not by the graph";
  for (std::size_t i = 0; i < walk.truth.size(); ++i) {
    EXPECT_LT((after.keyframes[i].world_from_body.translation -
               never.keyframes[i].world_from_body.translation)
                  .norm(),
              0.003);
  }
  const scene::MapVersion none = apply(after, withdraw_loop(after, second.cause, {}));
  EXPECT_NEAR(worst_error_m(walk, none), worst_error_m(walk, walk.map), 0.003);
  EXPECT_THROW(withdraw_loop(after, first.cause, {}), core::ContractError) << "withdrawn once";
}

TEST(WithdrawLoop, RecoversFromAnyDistortionOfTheMap) {
  const Walk walk = square_walk(0.01);
  const scene::LoopEdge wrong = false_loop(walk, 36, 3, 0.8);
  const scene::LoopEdge right = true_loop(walk, 40, 0);
  const scene::MapVersion never = apply(walk.map, close_loop(walk.map, right, {}).edit);
  scene::MapVersion map = apply(walk.map, close_loop(walk.map, wrong, {}).edit);
  scene::Edit distort;
  distort.loops = {right};
  core::Random random(1);
  for (std::size_t i = 1; i < walk.truth.size(); ++i) {
    const core::Rigid3 somewhere{core::exp_so3({0.0, random.uniform(-3.0, 3.0), 0.0}),
                                 {random.uniform(-9.0, 9.0), 0.0, random.uniform(-9.0, 9.0)}};
    distort.pose_changes.push_back({map.keyframes[i].id, somewhere});
  }
  map = apply(map, distort);
  ASSERT_GT(rms_error_m(walk, map), 5.0);
  const scene::MapVersion after = apply(map, withdraw_loop(map, wrong.cause, {}));
  EXPECT_LT(rms_error_m(walk, after), 1.02 * rms_error_m(walk, never));
}

TEST(CloseLoop, RefusesALoopToAMissingKeyframe) {
  const Walk walk = square_walk(0.0);
  scene::LoopEdge loop = true_loop(walk, 40, 0);
  loop.query = core::KeyframeId(99);
  EXPECT_THROW(close_loop(walk.map, loop, {}), core::ContractError);
}

TEST(CloseLoop, ALoopOfACulledKeyframeIsTransferredToItsHolder) {
  const Walk walk = square_walk(0.01);
  scene::Edit cull;
  cull.culled_keyframes = {core::KeyframeId(40)};
  const scene::MapVersion culled = apply(walk.map, cull);
  const scene::LoopEdge loop = true_loop(walk, 40, 0);
  EXPECT_THROW(close_loop(culled, loop, {}), core::ContractError);
  const std::optional<scene::LoopEdge> carried = between_holders(culled, loop);
  ASSERT_TRUE(carried.has_value());
  EXPECT_EQ(carried->query, core::KeyframeId(39));
  const scene::MapVersion closed = apply(culled, close_loop(culled, *carried, {}).edit);
  EXPECT_LT(worst_error_m(walk, closed), 0.25 * worst_error_m(walk, walk.map));
}

}  // namespace
}  // namespace samewhere::correct
