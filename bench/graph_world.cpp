#include "graph_world.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <samewhere/core/random.hpp>
#include <samewhere/geometry/alignment.hpp>

namespace samewhere::bench {
namespace {

constexpr double kTau = 2.0 * std::numbers::pi;
constexpr double kShift_m = 3.0;

using Pose = core::Rigid3;

// Forward is x; up leads away from the surface.
Pose on_surface(const Eigen::Vector3d& position, const Eigen::Vector3d& forward,
                const Eigen::Vector3d& up) {
  Eigen::Matrix3d rotation;
  rotation.col(0) = forward.normalized();
  rotation.col(2) = (up - up.dot(rotation.col(0)) * rotation.col(0)).normalized();
  rotation.col(1) = rotation.col(2).cross(rotation.col(0));
  return {Eigen::Quaterniond(rotation), position};
}

std::vector<Pose> sphere() {
  constexpr int kLaps = 50;
  constexpr int kPerLap = 50;
  constexpr double kRadius_m = 50.0;
  std::vector<Pose> poses;
  for (int i = 0; i < kLaps * kPerLap; ++i) {
    const double latitude = std::numbers::pi * ((i + 25.0) / (kLaps * kPerLap + 50.0) - 0.5);
    const double longitude = kTau * i / kPerLap;
    const Eigen::Vector3d up(std::cos(latitude) * std::cos(longitude),
                             std::cos(latitude) * std::sin(longitude), std::sin(latitude));
    const Eigen::Vector3d forward(-std::sin(longitude), std::cos(longitude), 0.0);
    poses.push_back(on_surface(kRadius_m * up, forward, up));
  }
  return poses;
}

std::vector<Pose> torus() {
  constexpr int kLaps = 100;
  constexpr int kPerLap = 50;
  constexpr double kRing_m = 30.0;
  constexpr double kTube_m = 10.0;
  std::vector<Pose> poses;
  for (int i = 0; i < kLaps * kPerLap; ++i) {
    const double along = kTau * i / (kLaps * kPerLap);
    const double around = kTau * i / kPerLap;
    const Eigen::Vector3d outward(std::cos(along), std::sin(along), 0.0);
    const Eigen::Vector3d up =
        std::cos(around) * outward + std::sin(around) * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d forward =
        -std::sin(around) * outward + std::cos(around) * Eigen::Vector3d::UnitZ();
    poses.push_back(on_surface(kRing_m * outward + kTube_m * up, forward, up));
  }
  return poses;
}

Pose planar(double x_m, double y_m, double heading_rad) {
  return {core::exp_so3({0.0, 0.0, heading_rad}), {x_m, y_m, 0.0}};
}

// Straight for four steps, then left, right or on; never out of a town of 100 m.
std::vector<Pose> grid(int num_poses, core::Random& random) {
  constexpr int kBlock = 4;
  constexpr double kHalfTown_m = 50.0;
  std::vector<Pose> poses = {Pose{}};
  int quarter = 0;
  for (int i = 1; i < num_poses; ++i) {
    if (i % kBlock == 0) quarter += static_cast<int>(random.uniform(0.0, 3.0)) - 1;
    for (int tries = 0; tries < 4; ++tries, ++quarter) {
      const double heading_rad = quarter * kTau / 4.0;
      const Eigen::Vector3d next = poses.back().translation +
                                   Eigen::Vector3d(std::cos(heading_rad), std::sin(heading_rad), 0);
      if (next.cwiseAbs().maxCoeff() > kHalfTown_m) continue;
      poses.push_back(planar(next.x(), next.y(), heading_rad));
      break;
    }
  }
  return poses;
}

std::vector<Pose> halls() {
  constexpr int kRounds = 20;
  constexpr int kSide = 25;  // steps of 1 m
  std::vector<Pose> poses = {Pose{}};
  for (int i = 1; i < kRounds * 4 * kSide; ++i) {
    const double heading_rad = (i / kSide) * kTau / 4.0;
    const Eigen::Vector3d next =
        poses.back().translation + Eigen::Vector3d(std::cos(heading_rad), std::sin(heading_rad), 0);
    poses.push_back(planar(next.x(), next.y(), heading_rad));
  }
  return poses;
}

using Pairs = std::vector<std::pair<int, int>>;

// From each pose to the one a lap before.
Pairs a_lap_before(std::size_t num_poses, int per_lap) {
  Pairs pairs;
  for (int i = per_lap; i < static_cast<int>(num_poses); ++i) pairs.emplace_back(i - per_lap, i);
  return pairs;
}

// From each pose to the last one that stood at the same crossing or street, if that is a while ago.
Pairs crossings(const std::vector<Pose>& poses) {
  constexpr int kWhile = 10;
  std::map<std::pair<long, long>, int> last;
  Pairs pairs;
  for (int i = 0; i < static_cast<int>(poses.size()); ++i) {
    const Eigen::Vector3d& at = poses[static_cast<std::size_t>(i)].translation;
    const std::pair spot(std::lround(at.x()), std::lround(at.y()));
    if (const auto before = last.find(spot); before != last.end() && i - before->second > kWhile)
      pairs.emplace_back(before->second, i);
    last[spot] = i;
  }
  return pairs;
}

core::Matrix6d information_of(const GraphNoise& noise) {
  core::Vector6d sigma;
  sigma << Eigen::Vector3d::Constant(noise.sigma_m), Eigen::Vector3d::Constant(noise.sigma_rad);
  return sigma.cwiseMax(1e-6).cwiseAbs2().cwiseInverse().asDiagonal();
}

Pose noise_of(const GraphNoise& noise, bool is_planar, core::Random& random) {
  core::Vector6d error;
  for (int i = 0; i < 6; ++i)
    error(i) = (i < 3 ? noise.sigma_m : noise.sigma_rad) * random.gaussian();
  if (is_planar) error.segment<3>(2).setZero();
  return {core::exp_so3(error.tail<3>()), error.head<3>()};
}

std::vector<std::size_t> loops_of(const GraphWorld& world) {
  std::vector<std::size_t> loops;
  for (std::size_t i = 0; i < world.graph.edges.size(); ++i)
    if (world.graph.edges[i].is_loop) loops.push_back(i);
  return loops;
}

}  // namespace

std::string_view name_of(GraphKind kind) {
  constexpr std::string_view kNames[] = {"sphere", "torus", "grid", "town", "halls"};
  return kNames[static_cast<int>(kind)];
}

GraphWorld make_graph(GraphKind kind, const GraphNoise& noise, std::uint64_t seed) {
  core::Random random(seed);
  GraphWorld world;
  Pairs loops;
  switch (kind) {
    case GraphKind::kSphere:
      world.world_from_node = sphere();
      loops = a_lap_before(world.world_from_node.size(), 50);
      break;
    case GraphKind::kTorus:
      world.world_from_node = torus();
      loops = a_lap_before(world.world_from_node.size(), 50);
      break;
    case GraphKind::kGrid:
    case GraphKind::kTown:
      world.world_from_node = grid(kind == GraphKind::kGrid ? 3500 : 10000, random);
      loops = crossings(world.world_from_node);
      break;
    case GraphKind::kHalls:
      world.world_from_node = halls();
      loops = a_lap_before(world.world_from_node.size(), 100);
      break;
  }
  optimize::PoseGraph& graph = world.graph;
  graph.is_planar = kind != GraphKind::kSphere && kind != GraphKind::kTorus;
  const auto add = [&](int a, int b, bool is_loop) {
    const Pose a_from_b = inverse(world.world_from_node[static_cast<std::size_t>(a)]) *
                          world.world_from_node[static_cast<std::size_t>(b)];
    const Pose error = noise_of(noise, graph.is_planar, random);
    graph.edges.push_back(
        {a,
         b,
         {a_from_b.rotation * error.rotation, a_from_b.translation + error.translation},
         information_of(noise),
         is_loop});
  };
  graph.world_from_node = {world.world_from_node.front()};
  for (int i = 1; i < static_cast<int>(world.world_from_node.size()); ++i) {
    add(i - 1, i, false);
    graph.world_from_node.push_back(graph.world_from_node.back() * graph.edges.back().a_from_b);
  }
  for (const auto& [a, b] : loops) add(a, b, true);
  world.is_outlier.assign(graph.edges.size(), false);
  return world;
}

GraphWorld with_exact_edges(GraphWorld world) {
  for (optimize::PoseEdge& edge : world.graph.edges)
    edge.a_from_b = inverse(world.world_from_node[static_cast<std::size_t>(edge.a)]) *
                    world.world_from_node[static_cast<std::size_t>(edge.b)];
  return world;
}

void add_random_outliers(GraphWorld& world, double share, std::uint64_t seed) {
  core::Random random(seed);
  for (const std::size_t loop : loops_of(world)) {
    if (random.uniform(0.0, 1.0) >= share) continue;
    optimize::PoseEdge& edge = world.graph.edges[loop];
    const int before = edge.a;
    while (edge.a == before || edge.a == edge.b)
      edge.a = static_cast<int>(random.uniform(0.0, edge.b));
    world.is_outlier[loop] = true;
  }
}

void add_consistent_outliers(GraphWorld& world, double share, std::uint64_t seed) {
  core::Random random(seed);
  const std::vector<std::size_t> loops = loops_of(world);
  const auto length = static_cast<std::size_t>(share * static_cast<double>(loops.size()));
  const auto begin =
      static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(loops.size() - length)));
  const double direction_rad = random.uniform(0.0, kTau);
  const Pose shift{Eigen::Quaterniond::Identity(),
                   {kShift_m * std::cos(direction_rad), kShift_m * std::sin(direction_rad), 0.0}};
  for (std::size_t i = begin; i < begin + length; ++i) {
    optimize::PoseEdge& edge = world.graph.edges[loops[i]];
    const Pose& a = world.world_from_node[static_cast<std::size_t>(edge.a)];
    edge.a_from_b = inverse(a) * shift * a * edge.a_from_b;
    world.is_outlier[loops[i]] = true;
  }
}

double ate_m(const GraphWorld& world) {
  std::vector<Eigen::Vector3d> found;
  std::vector<Eigen::Vector3d> truth;
  for (std::size_t i = 0; i < world.world_from_node.size(); ++i) {
    found.push_back(world.graph.world_from_node[i].translation);
    truth.push_back(world.world_from_node[i].translation);
  }
  const auto truth_from_found = geometry::align_points(found, truth, false);
  double sum = 0.0;
  for (std::size_t i = 0; i < found.size(); ++i)
    sum += (truth_from_found * found[i] - truth[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(found.size()));
}

}  // namespace samewhere::bench
