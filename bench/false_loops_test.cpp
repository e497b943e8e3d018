#include "false_loops.hpp"

#include <gtest/gtest.h>

#include <samewhere/map/test_map.hpp>

namespace samewhere::bench {
namespace {

constexpr int kKeyframes = 20;

core::Truth truth_of(const scene::MapVersion& map) {
  core::Truth truth;
  for (int i = 0; i < kKeyframes; ++i) {
    const features::View& view = map.keyframes[static_cast<std::size_t>(i)].view;
    truth.trajectory.push_back({view.stamp_s, map::test_walk(i) * view.rig->body_from_camera[0]});
  }
  return truth;
}

class FalseLoops : public testing::Test {
 protected:
  // The answer of loop closing for keyframe `query`: a candidate to the first keyframe, with a pose
  // error of `error_m`, rejected at `stage`, and an accepted loop.
  pipeline::LoopAnswer answer_to(std::size_t query, double error_m, core::Refusal stage) const {
    const core::CandidateId id(query);
    core::Rigid3 found = inverse(map::test_walk(0)) * map::test_walk(static_cast<int>(query));
    found.translation.x() += error_m;
    core::Rejection rejected{id, {}, stage, "for a reason"};
    rejected.evidence.geometry =
        core::GeometryEvidence{.match_from_query = core::Sim3::from_rigid(found)};
    pipeline::LoopAnswer answer;
    answer.rows.push_back({{.id = id,
                            .query = map_.keyframes[query].view.frame,
                            .match = map_.keyframes[0].view.frame},
                           rejected});
    answer.loops.push_back({scene::LoopEdge{.cause = core::CandidateId(999)}});
    return answer;
  }

  pipeline::FindLoops question(std::size_t query) const {
    return {map_, core::KeyframeId(query), {}};
  }

  scene::MapVersion map_ = map::test_map(features::test_world(3, 200), kKeyframes);
  FalseLoopInjector injector_{pipeline::Config{}, 5, truth_of(map_)};
};

TEST_F(FalseLoops, ACandidateRejectedByTheOdometryGateIsInjected) {
  const auto answer_of = [&](std::size_t query, double error_m, core::Refusal stage) {
    auto answer = answer_to(query, error_m, stage);
    injector_.answer(question(query), answer);
    return answer;
  };
  EXPECT_TRUE(answer_of(4, 1.0, core::Refusal::kOdometry).loops.empty()) << "too early";
  EXPECT_TRUE(answer_of(5, 1.0, core::Refusal::kInliers).loops.empty())
      << "rejected before the odometry gate";
  EXPECT_TRUE(answer_of(5, 0.1, core::Refusal::kOdometry).loops.empty()) << "nearly true";
  EXPECT_TRUE(answer_of(5, 9.0, core::Refusal::kOdometry).loops.empty())
      << "the pose graph would reject it";
  ASSERT_FALSE(injector_.false_loop());
  const auto answer = answer_of(5, 1.0, core::Refusal::kOdometry);
  ASSERT_TRUE(injector_.false_loop());
  EXPECT_NEAR(injector_.false_loop()->error_m, 1.0, 1e-9);
  EXPECT_EQ(injector_.false_loop()->before.number, map_.number);
  ASSERT_EQ(answer.loops.size(), 1U);
  EXPECT_EQ(answer.loops[0].edge.cause, injector_.false_loop()->loop.cause);
  EXPECT_TRUE(core::is_loop(answer.rows[0].verdict));
}

TEST_F(FalseLoops, TrueLoopsFollowInBothRuns) {
  auto injected = answer_to(6, 1.0, core::Refusal::kOdometry);
  injector_.answer(question(6), injected);
  ASSERT_TRUE(injector_.false_loop());
  auto reference = answer_to(6, 1.0, core::Refusal::kOdometry);
  injector_.answer_with_true_loops(question(6), reference);
  EXPECT_TRUE(reference.loops.empty());
  for (std::size_t query = 7; query < 17; ++query) {
    SCOPED_TRACE(query);
    auto answered = answer_to(query, 1.0, core::Refusal::kOdometry);
    injector_.answer(question(query), answered);
    auto true_only = answer_to(query, 1.0, core::Refusal::kOdometry);
    injector_.answer_with_true_loops(question(query), true_only);
    const bool is_time = query == 12 || query == 14 || query == 16;
    ASSERT_EQ(answered.loops.size(), is_time ? 1U : 0U) << "no second false loop, no other loop";
    ASSERT_EQ(true_only.loops.size(), answered.loops.size());
    if (!is_time) continue;
    const scene::LoopEdge& edge = answered.loops[0].edge;
    EXPECT_EQ(edge.match, core::KeyframeId(0));
    EXPECT_LT(
        (edge.match_from_query.translation - map::test_walk(static_cast<int>(query)).translation)
            .norm(),
        1e-9);
    EXPECT_EQ(true_only.loops[0].edge.cause, edge.cause);
    EXPECT_TRUE(FalseLoopInjector::true_causes().contains(edge.cause));
  }
  EXPECT_EQ(injector_.last_true_loop_at(map_), 18U);
}

}  // namespace
}  // namespace samewhere::bench
