#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/evaluate/loop_check.hpp>

namespace samewhere::evaluate {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

// Frame i at i tenths of a second; frame 3 sees the place of frame 0 from half a metre to the
// right.
core::Truth walk_and_return() {
  core::Truth truth;
  const double x_m[] = {0.0, 1.0, 1.0, 0.5};
  for (int i = 0; i < 4; ++i)
    truth.trajectory.push_back(
        {i / 10.0, {core::exp_so3({0, 0.2 * i, 0}), Eigen::Vector3d(x_m[i], 0, 0)}});
  return truth;
}

core::Rigid3 true_return() { return {core::exp_so3({0, 0.6, 0}), {0.5, 0, 0}}; }

AcceptedLoop loop_with(const std::optional<core::Rigid3>& match_from_query) {
  return {3, 0, 0.3, 0.0, match_from_query};
}

LoopTruth verdict_on(const core::Rigid3& match_from_query, double scale = 1.0) {
  return check_loops({loop_with(match_from_query)}, walk_and_return(), scale).loops[0].truth;
}

TEST(LoopCheck, TheTruePoseIsRight) {
  const LoopCheck check = check_loops({loop_with(true_return())}, walk_and_return());
  EXPECT_EQ(check.num_true, 1);
  ASSERT_TRUE(check.loops[0].translation_error_m);
  EXPECT_NEAR(*check.loops[0].translation_error_m, 0.0, 1e-9);
  EXPECT_NEAR(*check.loops[0].rotation_error_deg, 0.0, 1e-6);
}

TEST(LoopCheck, ARevisitIsClosedByARightLoopWithinIt) {
  core::Truth truth = walk_and_return();
  const LoopCheck unknown = check_loops({loop_with(true_return())}, truth);
  EXPECT_EQ(unknown.num_revisits, 0);
  truth.revisits = std::vector<core::FrameSpan>{{1, 2}, {3, 3}};
  const LoopCheck check = check_loops({loop_with(true_return())}, truth);
  EXPECT_EQ(check.num_revisits, 2);
  EXPECT_EQ(check.num_closed, 1);
  const LoopCheck with_false = check_loops({loop_with(core::inverse(true_return()))}, truth);
  EXPECT_EQ(with_false.num_closed, 0) << "a false loop closes no revisit";
}

TEST(LoopCheck, TheBordersAreTwentyCentimetresAndSixDegrees) {
  core::Rigid3 shifted = true_return();
  shifted.translation.y() = 0.199;
  EXPECT_EQ(verdict_on(shifted), LoopTruth::kTrue);
  shifted.translation.y() = 0.201;
  EXPECT_EQ(verdict_on(shifted), LoopTruth::kFalse);

  core::Rigid3 turned = true_return();
  turned.rotation = turned.rotation * core::exp_so3({5.9 * kDegree, 0, 0});
  EXPECT_EQ(verdict_on(turned), LoopTruth::kTrue);
  turned.rotation = true_return().rotation * core::exp_so3({6.1 * kDegree, 0, 0});
  EXPECT_EQ(verdict_on(turned), LoopTruth::kFalse);
}

TEST(LoopCheck, TheInverseOfALargeMotionIsWrong) {
  EXPECT_EQ(verdict_on(core::inverse(true_return())), LoopTruth::kFalse);
}

TEST(LoopCheck, AMonocularTranslationIsScaledFirst) {
  core::Rigid3 in_other_units = true_return();
  in_other_units.translation *= 10.0;
  EXPECT_EQ(verdict_on(in_other_units), LoopTruth::kFalse);
  EXPECT_EQ(verdict_on(in_other_units, 0.1), LoopTruth::kTrue);
}

TEST(LoopCheck, APoseThatIsNotANumberIsWrong) {
  core::Rigid3 broken = true_return();
  broken.translation.x() = std::nan("");
  EXPECT_EQ(verdict_on(broken), LoopTruth::kFalse);
}

TEST(LoopCheck, DoesNotDependOnWhereTheWorldBegins) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    core::Random random(seed);
    core::Vector6d tangent;
    for (double& value : tangent) value = random.gaussian();
    const core::Rigid3 other_from_world = core::exp_r3so3(tangent);
    core::Truth truth = walk_and_return();
    for (core::StampedPose& pose : truth.trajectory)
      pose.world_from_camera = other_from_world * pose.world_from_camera;
    const LoopCheck check = check_loops({loop_with(true_return())}, truth);
    EXPECT_NEAR(*check.loops[0].translation_error_m, 0.0, 1e-9);
  }
}

TEST(LoopCheck, WithoutPoseTruthTheMatrixDecides) {
  core::Truth truth;
  truth.places = core::PlaceTruthMatrix{4, std::vector<core::PlaceTruth>(16)};
  truth.places->values[12] = core::PlaceTruth::kSame;
  truth.places->values[13] = core::PlaceTruth::kNear;
  const LoopCheck check = check_loops(
      {{3, 0, 0.3, 0.0, std::nullopt}, {3, 1, 0.3, 0.1, true_return()}, {2, 0, 0.2, 0.0, {}}},
      truth);
  EXPECT_EQ(check.loops[0].truth, LoopTruth::kTrue);
  EXPECT_EQ(check.loops[1].truth, LoopTruth::kUnknown);
  EXPECT_EQ(check.loops[2].truth, LoopTruth::kFalse);
  EXPECT_EQ(check.num_true, 1);
  EXPECT_EQ(check.num_unknown, 1);
  EXPECT_EQ(check.num_false, 1);
  EXPECT_FALSE(check.loops[1].translation_error_m);
  EXPECT_THROW(check_loops({{9, 0, 0.0, 0.0, {}}}, truth), core::InputError);
}

TEST(LoopCheck, ALoopWithoutAPoseFallsBackToTheMatrix) {
  core::Truth truth = walk_and_return();
  EXPECT_EQ(check_loops({loop_with(std::nullopt)}, truth).num_unknown, 1);
  truth.places = core::PlaceTruthMatrix{4, std::vector<core::PlaceTruth>(16)};
  EXPECT_EQ(check_loops({loop_with(std::nullopt)}, truth).num_false, 1);
}

TEST(LoopCheck, FalseLoopsOfAliasedPairsAreCounted) {
  core::Truth truth;
  truth.places = core::PlaceTruthMatrix{4, std::vector<core::PlaceTruth>(16)};
  truth.aliased_pairs = {{2, 0}, {3, 1}};
  const LoopCheck check = check_loops(
      {{3, 0, 0.3, 0.0, {}}, {3, 1, 0.3, 0.1, {}}, {2, 0, 0.2, 0.0, {}}, {2, 1, 0.2, 0.1, {}}},
      truth);
  EXPECT_EQ(check.num_false, 4);
  EXPECT_EQ(check.num_aliased, 2);
  truth.aliased_pairs.clear();
  EXPECT_EQ(check_loops({{3, 1, 0.3, 0.1, {}}}, truth).num_aliased, 0);
}

TEST(LoopCheck, OutsideTheTruthNothingIsKnown) {
  AcceptedLoop late = loop_with(true_return());
  late.query_stamp_s = 7.0;
  EXPECT_EQ(check_loops({late}, walk_and_return()).num_unknown, 1);
  EXPECT_EQ(check_loops({loop_with(true_return())}, {}).num_unknown, 1);
  EXPECT_TRUE(check_loops({}, walk_and_return()).loops.empty());
}

}  // namespace
}  // namespace samewhere::evaluate
