#include <algorithm>
#include <array>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <samewhere/verify/test_corridor.hpp>

namespace samewhere::verify {
namespace {

using geometry::UncertainPose;

// A pose whose parts all differ.
core::Rigid3 step(int i) {
  const double t = i;
  return {core::exp_so3({0.05 * std::sin(t), 0.3 * std::cos(1.3 * t), 0.02 * std::cos(t)}),
          {0.1 * std::cos(2.0 * t), 0.05 * std::sin(t), 0.5 + 0.1 * std::sin(3.0 * t)}};
}

core::Matrix6d covariance(int i) {
  core::Matrix6d root = 0.01 * core::Matrix6d::Identity();
  for (int k = 0; k < 6; ++k) root(k, (k + i) % 6) += 0.004 * std::cos(i + k);
  return root * root.transpose();
}

// Keyframes with these parents; -1: the first of a session.
scene::MapVersion map_of(const std::vector<int>& parents) {
  scene::MapVersion map;
  for (std::size_t i = 0; i < parents.size(); ++i) {
    scene::Keyframe keyframe;
    keyframe.id = core::KeyframeId(i);
    keyframe.view.stamp_s = 0.5 * static_cast<double>(i);
    const int n = static_cast<int>(i);
    if (parents[i] >= 0)
      keyframe.odometry = {keyframe_id(parents[i]), step(n), covariance(n).inverse()};
    map.keyframes.push_back(keyframe);
  }
  return map;
}

scene::MapVersion chain_of(int count) {
  std::vector<int> parents;
  for (int i = 0; i < count; ++i) parents.push_back(i - 1);
  return map_of(parents);
}

// Edge by edge; `descendants`: each a child of the one before, the first a child of the ancestor.
UncertainPose composed(const scene::MapVersion& map, const std::vector<int>& descendants) {
  UncertainPose ancestor_from_end;
  for (const int i : descendants) {
    const auto& edge = *map.at(keyframe_id(i)).odometry;
    ancestor_from_end =
        compose(ancestor_from_end, {edge.parent_from_keyframe, edge.information.inverse()});
  }
  return ancestor_from_end;
}

void expect_same(const std::optional<UncertainPose>& found, const UncertainPose& expected) {
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->a_from_b.translation.isApprox(expected.a_from_b.translation, 1e-9));
  EXPECT_LT(core::angle_rad(found->a_from_b.rotation.conjugate() * expected.a_from_b.rotation),
            1e-7);
  EXPECT_TRUE(found->covariance.isApprox(expected.covariance, 1e-9))
      << found->covariance << "\nexpected\n"
      << expected.covariance;
}

TEST(OdometryTree, ComposesTheEdgesDown) {
  const scene::MapVersion map = chain_of(12);
  OdometryTree tree;
  tree.follow(map);
  expect_same(tree.between(keyframe_id(0), keyframe_id(3)), composed(map, {1, 2, 3}));
  expect_same(tree.between(keyframe_id(7), keyframe_id(11)), composed(map, {8, 9, 10, 11}));
  EXPECT_TRUE(tree.between(keyframe_id(5), keyframe_id(5))->covariance.isZero());
}

TEST(OdometryTree, ComposesThemThroughTheYoungestCommonAncestor) {
  // 0 - 1 - 2 - 3 - 4
  //          \- 5 - 6
  const scene::MapVersion map = map_of({-1, 0, 1, 2, 3, 2, 5});
  OdometryTree tree;
  tree.follow(map);
  const UncertainPose common_from_begin = composed(map, {3, 4});
  const UncertainPose common_from_end = composed(map, {5, 6});
  expect_same(tree.between(keyframe_id(4), keyframe_id(6)),
              compose(inverse(common_from_begin), common_from_end));
  EXPECT_EQ(tree.path(keyframe_id(4), keyframe_id(6)),
            (std::vector{keyframe_id(6), keyframe_id(5), keyframe_id(2), keyframe_id(3),
                         keyframe_id(4)}));
  expect_same(tree.between(keyframe_id(4), keyframe_id(1)), inverse(composed(map, {2, 3, 4})));
}

TEST(OdometryTree, KnowsNothingBetweenSessions) {
  OdometryTree tree;
  tree.follow(map_of({-1, 0, -1, 2}));
  EXPECT_FALSE(tree.between(keyframe_id(1), keyframe_id(3)));
  EXPECT_TRUE(tree.path(keyframe_id(1), keyframe_id(3)).empty());
  EXPECT_EQ(tree.origin(keyframe_id(3)), keyframe_id(2));
  EXPECT_EQ(tree.parent(keyframe_id(3)), keyframe_id(2));
  EXPECT_FALSE(tree.parent(keyframe_id(2)));
}

constexpr SystematicDrift kBias{.per_metre = 0.05,
                                .rad_per_metre = 0.02,
                                .rad_per_radian = 0.03,
                                .rad_per_s = 0.001,
                                .tilt_ratio = 0.1};

// The second half of the chain, in a map that begins there.
TEST(OdometryTree, ConstantErrorsDoNotDependOnWhereTheMapBegins) {
  scene::MapVersion whole = chain_of(21);
  scene::MapVersion half;
  for (int i = 10; i <= 20; ++i) {
    scene::Keyframe keyframe = whole.at(keyframe_id(i));
    keyframe.id = keyframe_id(i - 10);
    if (i == 10)
      keyframe.odometry.reset();
    else
      keyframe.odometry->parent = keyframe_id(i - 11);
    half.keyframes.push_back(keyframe);
  }
  OdometryTree of_whole(kBias);
  of_whole.follow(whole);
  OdometryTree of_half(kBias);
  of_half.follow(half);
  for (const auto& [begin, end] : {std::pair{0, 10}, std::pair{2, 9}, std::pair{9, 2}})
    EXPECT_TRUE(
        of_whole.systematic_covariance(keyframe_id(begin + 10), keyframe_id(end + 10))
            .isApprox(of_half.systematic_covariance(keyframe_id(begin), keyframe_id(end)), 1e-9))
        << begin << " to " << end;
}

// All distances 1 % too long, all turns 1 % too large: where the end would come to lie.
TEST(OdometryTree, ConstantErrorsMoveTheEndAsTheyMoveEachEdge) {
  const scene::MapVersion map = chain_of(8);
  const auto end_with = [&](double longer, double turned) {
    core::Rigid3 begin_from_end;
    for (int i = 3; i < 8; ++i) {
      const core::Rigid3 edge = step(i);
      begin_from_end = begin_from_end *
                       core::Rigid3{core::exp_so3((1.0 + turned) * core::log_so3(edge.rotation)),
                                    (1.0 + longer) * edge.translation};
    }
    return begin_from_end;
  };
  const auto deviation_of = [&](const SystematicDrift& bias) {
    OdometryTree tree(bias);
    tree.follow(map);
    return core::Vector6d(
        tree.systematic_covariance(keyframe_id(2), keyframe_id(7)).diagonal().cwiseSqrt());
  };
  constexpr double kSmall = 1e-5;
  const Eigen::Vector3d by_length =
      (end_with(kSmall, 0.0).translation - end_with(0.0, 0.0).translation).cwiseAbs();
  EXPECT_TRUE(deviation_of({.per_metre = kSmall}).head<3>().isApprox(by_length, 1e-3));
  const Eigen::Vector3d by_turn =
      (end_with(0.0, kSmall).translation - end_with(0.0, 0.0).translation).cwiseAbs();
  EXPECT_TRUE(deviation_of({.rad_per_radian = kSmall}).head<3>().isApprox(by_turn, 1e-3));
  const Eigen::Vector3d rotated =
      core::log_so3(end_with(0.0, 0.0).rotation.conjugate() * end_with(0.0, kSmall).rotation)
          .cwiseAbs();
  EXPECT_TRUE(deviation_of({.rad_per_radian = kSmall}).tail<3>().isApprox(rotated, 1e-3));
}

TEST(OdometryTree, FollowsAMapWhoseEdgesChange) {
  scene::MapVersion map = chain_of(10);
  OdometryTree tree(kBias);
  tree.follow(map);
  map.keyframes.edit(4).odometry->parent_from_keyframe.translation *= 1.1;
  map.keyframes.edit(6).odometry->information *= 2.0;
  map.keyframes.shrink(9);
  tree.follow(map);
  OdometryTree fresh(kBias);
  fresh.follow(map);
  for (int begin = 0; begin < 9; ++begin) {
    const auto followed = tree.between(keyframe_id(begin), keyframe_id(8));
    const auto expected = fresh.between(keyframe_id(begin), keyframe_id(8));
    EXPECT_EQ(followed->covariance, expected->covariance) << begin;
    EXPECT_EQ(followed->a_from_b.translation, expected->a_from_b.translation) << begin;
  }
}

// Of a walk of 3 km the error between neighbours is that of one edge.
TEST(OdometryTree, IsAsExactFarFromTheOrigin) {
  const scene::MapVersion map = corridor(3001);
  OdometryTree tree;
  tree.follow(map);
  const auto near = tree.between(keyframe_id(0), keyframe_id(2));
  const auto far = tree.between(keyframe_id(2998), keyframe_id(3000));
  EXPECT_LT((far->covariance - near->covariance).cwiseAbs().maxCoeff(), 1e-7);
}

}  // namespace
}  // namespace samewhere::verify
