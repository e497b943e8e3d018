#include <sstream>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/optimize/g2o_file.hpp>

namespace samewhere::optimize {
namespace {

core::Rigid3 random_pose(core::Random& random, double size) {
  core::Vector6d tangent;
  for (double& value : tangent) value = size * random.gaussian();
  return core::exp_r3so3(tangent);
}

core::Matrix6d any_information(core::Random& random) {
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

TEST(G2oFile, AnEdgeHasTheSameCostInG2o) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    core::Random random(seed);
    const PoseEdge edge{0, 1, random_pose(random, 1.0), any_information(random), false};
    const core::Rigid3 found = edge.a_from_b * random_pose(random, 1e-4);
    const core::Vector6d ours = edge_error(edge, core::Rigid3{}, found);
    const core::Vector6d theirs = g2o_error(edge.a_from_b, found);
    const double cost = ours.dot(edge.information * ours);
    EXPECT_NEAR(theirs.dot(g2o_information(edge) * theirs) / cost, 1.0, 1e-3) << "seed " << seed;
  }
}

// A keyframe may be tracked from an older one than the last, and a loop may join the same two, be
// they neighbours or not.
TEST(G2oFile, OdometryBetweenDistantNumbersStaysOdometry) {
  core::Random random(3);
  PoseGraph graph;
  for (int i = 0; i < 4; ++i) graph.world_from_node.push_back(random_pose(random, 1.0));
  const auto edge = [&](int a, int b, bool is_loop) {
    return PoseEdge{a, b, random_pose(random, 1.0), any_information(random), is_loop};
  };
  graph.edges = {edge(0, 1, false), edge(0, 3, false), edge(1, 2, false), edge(0, 3, true),
                 edge(1, 3, true),  edge(2, 1, true),  edge(3, 2, false), edge(2, 3, true)};
  const std::filesystem::path path =
      testing::TempDir() + "g2o_odometry_" + std::to_string(getpid()) + ".g2o";
  core::write_file(path, g2o_text(graph));
  const G2oGraph found = read_g2o(path);
  std::filesystem::remove(path);
  EXPECT_TRUE(found.skipped.empty());
  ASSERT_EQ(found.graph.edges.size(), graph.edges.size());
  for (std::size_t i = 0; i < graph.edges.size(); ++i)
    EXPECT_EQ(found.graph.edges[i].is_loop, graph.edges[i].is_loop) << "edge " << i;
}

TEST(G2oFile, HasALineForEachNodeAndEdge) {
  core::Random random(1);
  PoseGraph graph;
  for (int i = 0; i < 4; ++i) graph.world_from_node.push_back(random_pose(random, 1.0));
  graph.edges = {{0, 1, random_pose(random, 1.0), any_information(random), false},
                 {1, 3, random_pose(random, 1.0), any_information(random), true}};
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
    const int num_expected = tag == "FIX"             ? 0
                             : tag == kG2oLoop        ? 1
                             : tag == "EDGE_SE3:QUAT" ? 1 + 7 + 21
                                                      : 7;
    EXPECT_EQ(num_numbers, num_expected) << line;
  }
  EXPECT_EQ(seen,
            "VERTEX_SE3:QUAT 0\nVERTEX_SE3:QUAT 1\nVERTEX_SE3:QUAT 3\nFIX 0\nLOOP 1\n"
            "EDGE_SE3:QUAT 0\nEDGE_SE3:QUAT 1\n")
      << "node 2 hangs on no edge: a culled keyframe";
}

class G2oRead : public ::testing::Test {
 protected:
  G2oGraph read(const std::string& text) const {
    core::write_file(path_, text);
    return read_g2o(path_);
  }

  // What the file is refused with.
  std::string complaint(const std::string& text) const {
    try {
      read(text);
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "";
  }

  // of each test its own: they may run at once
  const std::string path_ = ::testing::TempDir() + "g2o_read_" +
                            ::testing::UnitTest::GetInstance()->current_test_info()->name() +
                            ".g2o";
};

// A ring with chords, in space or in the plane.
PoseGraph ring(core::Random& random, bool is_planar) {
  const auto pose = [&] {
    return is_planar ? core::Rigid3{core::exp_so3({0.0, 0.0, random.gaussian()}),
                                    {random.gaussian(), random.gaussian(), 0.0}}
                     : random_pose(random, 1.0);
  };
  PoseGraph graph;
  graph.is_planar = is_planar;
  for (int i = 0; i < 6; ++i) graph.world_from_node.push_back(pose());
  for (int i = 0; i < 6; ++i) {
    graph.edges.push_back({i, (i + 1) % 6, pose(), any_information(random), i == 5});
    if (is_planar) {  // nothing joins the plane to what leaves it
      core::Matrix6d& information = graph.edges.back().information;
      const Eigen::Matrix3d planar = information(kPlanarRows, kPlanarRows);
      information = core::Matrix6d::Identity();
      information(kPlanarRows, kPlanarRows) = planar;
    }
  }
  return graph;
}

TEST_F(G2oRead, RoundTripInSpaceAndInThePlane) {
  for (const bool is_planar : {false, true}) {
    core::Random random(is_planar ? 5 : 6);
    const PoseGraph graph = ring(random, is_planar);
    const G2oGraph found = read(g2o_text(graph, {10, 11, 12, 13, 14, 15}));
    EXPECT_EQ(found.names, (std::vector<long>{10, 11, 12, 13, 14, 15}));
    EXPECT_EQ(found.graph.is_planar, is_planar);
    EXPECT_EQ(found.graph.fixed_nodes, std::vector<int>{0});
    ASSERT_EQ(found.graph.edges.size(), graph.edges.size());
    for (std::size_t i = 0; i < graph.edges.size(); ++i) {
      EXPECT_LT(core::log_r3so3(inverse(graph.world_from_node[i]) * found.graph.world_from_node[i])
                    .norm(),
                1e-9);
      EXPECT_EQ(found.graph.edges[i].is_loop, graph.edges[i].is_loop);
      EXPECT_NEAR(chi2_of(found.graph, found.graph.edges[i]) / chi2_of(graph, graph.edges[i]), 1.0,
                  1e-9);
    }
  }
}

TEST_F(G2oRead, TheOrderOfVertexLinesDoesNotMatter) {
  core::Random random(4);
  const std::string text = g2o_text(ring(random, false), {10, 11, 12, 13, 14, 15});
  const auto lines_with = [&](bool is_vertex) {
    std::vector<std::string> lines;
    std::istringstream all(text);
    for (std::string line; std::getline(all, line);)
      if (line.starts_with("VERTEX") == is_vertex) lines.push_back(line + "\n");
    return lines;
  };
  std::string turned_round;
  for (const std::string& line : lines_with(true)) turned_round.insert(0, line);
  for (const std::string& line : lines_with(false)) turned_round += line;
  ASSERT_NE(turned_round, text);
  EXPECT_EQ(g2o_text(read(turned_round).graph, read(turned_round).names),
            g2o_text(read(text).graph, read(text).names));
}

TEST_F(G2oRead, EveryVertexOfAFixLineIsFixed) {
  core::Random random(4);
  EXPECT_EQ(read(g2o_text(ring(random, false)) + "FIX 2 4 5\n").graph.fixed_nodes,
            (std::vector<int>{0, 2, 4, 5}));
}

TEST_F(G2oRead, LinesOfUnknownTypesAreCounted) {
  core::Random random(1);
  const std::string text = g2o_text(ring(random, false));
  const G2oGraph found = read("VERTEX_XY 7 1 2\n" + text + "EDGE_SE3_XYZ 1 2\nVERTEX_XY 8 1 2\n");
  EXPECT_EQ(found.skipped, (std::map<std::string, int>{{"VERTEX_XY", 2}, {"EDGE_SE3_XYZ", 1}}));
  EXPECT_EQ(found.graph.edges.size(), 6U);
}

TEST_F(G2oRead, OdometryJoinsANumberToTheNextThatIsThere) {
  const std::string unit = " 1 0 0 1 0 0 1 0 1\n";
  std::string text;
  for (const int name : {10, 12, 40, 41}) text += fmt::format("VERTEX_SE2 {} 0 0 0\n", name);
  // either direction; the second of one pair is a loop
  const std::pair<std::string, bool> edges[] = {{"10 12", false}, {"40 12", false},
                                                {"40 41", false}, {"40 41", true},
                                                {"41 10", true},  {"10 40", true}};
  for (const auto& edge : edges) text += "EDGE_SE2 " + edge.first + unit;
  const G2oGraph found = read(text + "VERTEX_XY 11 5 5\nFIX 11\n");
  ASSERT_EQ(found.graph.edges.size(), std::size(edges));
  for (std::size_t i = 0; i < std::size(edges); ++i)
    EXPECT_EQ(found.graph.edges[i].is_loop, edges[i].second) << edges[i].first;
  EXPECT_TRUE(found.graph.fixed_nodes.empty()) << "a landmark";
}

TEST_F(G2oRead, OdometryDoesNotJoinTwoRobots) {
  const long a = 97L << 56;
  const long b = 98L << 56;
  std::string text;
  for (const auto& [from, to] : {std::pair(a, a + 1), std::pair(b, b + 2), std::pair(a + 1, b)})
    text += fmt::format("EDGE_SE2 {} {} 1 0 0 1 0 0 1 0 1\n", from, to);
  const G2oGraph found = read(text);
  EXPECT_FALSE(found.graph.edges.at(0).is_loop);
  EXPECT_FALSE(found.graph.edges.at(1).is_loop);
  EXPECT_TRUE(found.graph.edges.at(2).is_loop);
}

TEST_F(G2oRead, WithoutVerticesThePosesFollowTheEdges) {
  const G2oGraph found =
      read("EDGE_SE2 5 7 1 0 1.5707963 1 0 0 1 0 1\nEDGE_SE2 9 7 -2 0 0 1 0 0 1 0 1\n");
  EXPECT_TRUE(found.is_without_vertices);
  EXPECT_EQ(found.names, (std::vector<long>{5, 7, 9}));
  EXPECT_NEAR(found.graph.world_from_node[2].translation.x(), 1.0, 1e-6);
  EXPECT_NEAR(found.graph.world_from_node[2].translation.y(), 2.0, 1e-6);
}

TEST_F(G2oRead, ASingularInformationIsRaised) {
  const std::string vertices = "VERTEX_SE2 1 0 0 0\nVERTEX_SE2 2 1 0 0\n";
  for (const std::string information : {"4 0 0 4 0 0", "4 4 0 4 0 1", "4 0 0 4 0 -1e-12"}) {
    const G2oGraph found = read(vertices + "EDGE_SE2 1 2 1 0 0 " + information + "\n");
    const Eigen::SelfAdjointEigenSolver<core::Matrix6d> solver(found.graph.edges.at(0).information);
    EXPECT_GT(solver.eigenvalues()(0), 0.0) << information;
    EXPECT_LT(solver.eigenvalues()(0), 1e-7) << information;
  }
}

TEST_F(G2oRead, ALoopBetweenNeighboursStaysOne) {
  PoseGraph graph;
  graph.world_from_node.resize(3);
  graph.edges = {{0, 1}, {1, 2}};
  graph.edges[1].is_loop = true;
  const G2oGraph found = read(g2o_text(graph));
  EXPECT_FALSE(found.graph.edges.at(0).is_loop);
  EXPECT_TRUE(found.graph.edges.at(1).is_loop);
}

TEST(G2oChi2, TakesTwiceTheSineOfHalfTheAngle) {
  PoseGraph graph;
  graph.world_from_node = {core::Rigid3{}, {core::exp_so3({0.0, 0.6, 0.8}), {0.0, 0.3, 0.0}}};
  const PoseEdge edge{0, 1, core::Rigid3{}};
  EXPECT_NEAR(chi2_of(graph, edge), 1.0 + 0.09, 1e-12);
  EXPECT_NEAR(g2o_chi2_of(graph, edge), 4.0 * std::pow(std::sin(0.5), 2) + 0.09, 1e-12);
}

TEST_F(G2oRead, AnErrorNamesTheLine) {
  const std::string vertices = "VERTEX_SE2 1 0 0 0\nVERTEX_SE2 2 1 0 0\n";
  const std::string edge = "EDGE_SE2 1 2 1 0 0 1 0 0 1 0 1\n";
  EXPECT_EQ(complaint(vertices + edge), "");
  using ::testing::HasSubstr;
  const std::pair<std::string, std::string> broken[] = {
      {"", "holds 0 vertices and 0 edges, expected some of both"},
      {vertices, "holds 2 vertices and 0 edges"},
      {vertices + "EDGE_SE2 1 2 1 0 0 1 0 0\n", "line 3: found 8 values, expected 11 of EDGE_SE2"},
      {vertices + "EDGE_SE2 1 2 nan 0 0 1 0 0 1 0 1\n", "line 3: found 'nan', expected a finite"},
      {vertices + "EDGE_SE2 1 2 1 0 0 1 2 0 1 0 1\n",
       "line 3: an information that is not positive"},
      {vertices + "EDGE_SE2 1 3 1 0 0 1 0 0 1 0 1\n", "line 3: names vertex 3"},
      {vertices + "EDGE_SE2 1 1 1 0 0 1 0 0 1 0 1\n", "line 3: joins 1 to itself"},
      {vertices + "EDGE_SE2 1 -2 1 0 0 1 0 0 1 0 1\n", "line 3: found '-2', expected the number"},
      {vertices + "VERTEX_SE2 1 0 0 0\n" + edge, "line 3: vertex 1 a second time"},
      {vertices + "VERTEX_SE3:QUAT 3 0 0 0 0 0 0 1\n" + edge, "expected all of one kind"},
      {"VERTEX_SE3:QUAT 3 0 0 0 0 0 0 2\n" + edge, "line 1: quaternion of norm 2, expected 1"},
      {vertices + edge + "FIX\n", "line 4: found no number"},
      {vertices + edge + std::string(kG2oOdometry) + " 1\n", "line 4: found 1 values, expected 2"},
      {vertices + edge + std::string(kG2oOdometry) + " 1 9\n", "line 4: names vertex 9"},
      {vertices + edge + "FIX 1 9\n", "line 4: names vertex 9"},
      {"VERTEX_SE2 0 1e308 0 0\n" + vertices + edge, "line 1: found 1e308, expected a pose"},
      {vertices + "EDGE_SE2 1 2 1 0 0 -1 0 0 -1 0 -1\n", "line 3: an information that is not"},
      {vertices + "EDGE_SE2 1 2 1 0 0 0 0 0 0 0 0\n", "line 3: an information that is not"},
      {vertices + edge + "FIX 9\n", "line 4: names vertex 9"}};
  for (const auto& [text, expected] : broken) {
    EXPECT_THAT(complaint(text), HasSubstr(expected)) << text;
    EXPECT_THAT(complaint(text), HasSubstr("g2o_read_AnErrorNamesTheLine.g2o")) << text;
  }
}

TEST_F(G2oRead, ATruncatedFileIsReadOrRefused) {
  core::Random random(2);
  const std::string text = g2o_text(ring(random, false));
  int num_refused = 0;
  for (std::size_t length = 0; length < text.size(); length += 7)
    num_refused += complaint(text.substr(0, length)).empty() ? 0 : 1;
  EXPECT_GT(num_refused, 100);
}

}  // namespace
}  // namespace samewhere::optimize
