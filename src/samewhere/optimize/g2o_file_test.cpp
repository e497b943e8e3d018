#include <sstream>

#include <gtest/gtest.h>

#include <samewhere/core/random.hpp>
#include <samewhere/optimize/g2o_file.hpp>

namespace samewhere::optimize {
namespace {

core::Rigid3 random_pose(core::Random& random, double size) {
  core::Vector6d tangent;
  for (double& value : tangent) value = size * random.gaussian();
  return core::exp_r3so3(tangent);
}

core::Matrix6d random_information(core::Random& random) {
  core::Matrix6d root;
  for (double& value : root.reshaped()) value = random.gaussian();
  return root * root.transpose() + core::Matrix6d::Identity();
}

// The error as g2o has it: translation, and vector part of the quaternion, of measured^-1 * found.
core::Vector6d g2o_error(const core::Rigid3& measured, const core::Rigid3& found) {
  const core::Rigid3 apart = inverse(measured) * found;
  core::Vector6d error;
  error << apart.translation, apart.rotation.vec() * (apart.rotation.w() < 0.0 ? -1.0 : 1.0);
  return error;
}

TEST(G2oFile, AnEdgeCostsInG2oWhatItCostsHere) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    core::Random random(seed);
    const PoseEdge edge{0, 1, random_pose(random, 1.0), random_information(random), false};
    const core::Rigid3 found = edge.a_from_b * random_pose(random, 1e-4);
    const core::Vector6d ours = edge_error(edge, core::Rigid3{}, found);
    const core::Vector6d theirs = g2o_error(edge.a_from_b, found);
    const double cost = ours.dot(edge.information * ours);
    EXPECT_NEAR(theirs.dot(g2o_information(edge) * theirs) / cost, 1.0, 1e-3) << "seed " << seed;
  }
}

TEST(G2oFile, HasALineForEachNodeAndEdge) {
  core::Random random(1);
  PoseGraph graph;
  for (int i = 0; i < 4; ++i) graph.world_from_node.push_back(random_pose(random, 1.0));
  graph.edges = {{0, 1, random_pose(random, 1.0), random_information(random), false},
                 {1, 3, random_pose(random, 1.0), random_information(random), true}};
  std::istringstream lines(g2o_text(graph));
  std::string seen;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string tag;
    std::string first;
    words >> tag >> first;
    seen += tag + " " + first + "\n";
    int num_numbers = 0;
    for (double number = 0.0; words >> number;) ++num_numbers;
    const int num_expected = tag == "FIX" ? 0 : tag == "EDGE_SE3:QUAT" ? 1 + 7 + 21 : 7;
    EXPECT_EQ(num_numbers, num_expected) << line;
  }
  EXPECT_EQ(seen,
            "VERTEX_SE3:QUAT 0\nVERTEX_SE3:QUAT 1\nVERTEX_SE3:QUAT 3\nFIX 0\n"
            "EDGE_SE3:QUAT 0\nEDGE_SE3:QUAT 1\n")
      << "node 2 hangs on no edge: a culled keyframe";
}

}  // namespace
}  // namespace samewhere::optimize
