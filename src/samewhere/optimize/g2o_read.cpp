#include <charconv>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/text_file.hpp>
#include <samewhere/optimize/g2o_file.hpp>
#include <samewhere/optimize/spanning_tree.hpp>

namespace samewhere::optimize {
namespace {

constexpr double kMaxNormError = 1e-2;  // of a quaternion that files round
constexpr double kMaxNumber = 1e9;      // of a pose: beyond, squares leave what numbers can hold
constexpr double kMaxNegative = 1e-6;   // of the largest eigenvalue: below 0 by rounding
constexpr double kLeastShare = 1e-9;    // of the largest eigenvalue: what a direction gets at least
constexpr int kRobotBits = 56;          // GTSAM's keys: a letter, then the number

[[noreturn]] void refuse(const core::TextLine& line, const std::string& what) {
  throw core::InputError(fmt::format("{}: {}", line.place, what));
}

// How a kind of vertex and edge is written.
struct Kind {
  std::string_view vertex;
  std::string_view edge;
  std::size_t num_pose = 0;  // numbers of a pose
  int num_degrees = 0;
  bool is_planar = false;
};

constexpr Kind kSpatial{"VERTEX_SE3:QUAT", "EDGE_SE3:QUAT", 7, 6, false};
constexpr Kind kPlanar{"VERTEX_SE2", "EDGE_SE2", 3, 3, true};

// A file as it is read, line by line: vertices may come after the edges that name them.
class Reader {
  using Ends = std::pair<int, int>;  // nodes of an edge, the lower first

 public:
  explicit Reader(const std::filesystem::path& path) {
    for (const core::TextLine& line : core::read_text_lines(path)) read(line);
    const bool is_without_vertices = node_of_.empty();
    if (is_without_vertices) make_vertices();
    sort_by_name();
    for (const auto& line : odometry_) note_odometry(line);
    for (const auto& line : loops_) note_loop(line);
    for (const auto& [line, kind] : edges_) add_edge(line, *kind);
    for (const auto& line : fixed_) fix(line);
    if (found_.names.empty() || found_.graph.edges.empty()) {
      throw core::InputError(
          fmt::format("{}: holds {} vertices and {} edges, expected some of both "
                      "(VERTEX_SE3:QUAT and EDGE_SE3:QUAT, or VERTEX_SE2 and EDGE_SE2)",
                      path.string(), found_.names.size(), found_.graph.edges.size()));
    }
    found_.is_without_vertices = is_without_vertices;
    if (is_without_vertices) place_by_spanning_tree(found_.graph);
    warn_of_projected(path);
  }

  G2oGraph take() { return std::move(found_); }

 private:
  void read(const core::TextLine& line) {
    const std::string& type = line.words.front();
    for (const Kind* kind : {&kSpatial, &kPlanar}) {
      if (type == kind->vertex) return add_vertex(line, *kind);
      if (type == kind->edge) return edges_.emplace_back(line, kind), void();
    }
    if (type == "FIX") {
      fixed_.push_back(line);
    } else if (type == kG2oOdometry) {
      odometry_.push_back(line);
    } else if (type == kG2oLoop) {
      loops_.push_back(line);
    } else {
      if (type.starts_with("VERTEX_") && line.words.size() > 1) others_.insert(line.words[1]);
      ++found_.skipped[core::printable(type)];
    }
  }

  void add_vertex(const core::TextLine& line, const Kind& kind) {
    expect(line, 2 + kind.num_pose, kind);
    const long name = name_of(line, 1);
    const auto node = static_cast<int>(found_.names.size());
    if (!node_of_.emplace(name, node).second)
      refuse(line, fmt::format("vertex {} a second time, expected once", name));
    found_.names.push_back(name);
    found_.graph.world_from_node.push_back(pose_of(line, 2, kind));
  }

  // A file of edges alone: each number that an edge names is a node, at the origin for now.
  void make_vertices() {
    for (const auto& [line, kind] : edges_) {
      for (const std::size_t column : {1, 2}) {
        const long name = name_of(line, column);
        if (!node_of_.emplace(name, static_cast<int>(found_.names.size())).second) continue;
        found_.names.push_back(name);
        found_.graph.world_from_node.emplace_back();
      }
    }
  }

  // Nodes are in the order of the trajectory, whatever that of the lines is: which loops are
  // rejected depends on it (loop_segments.hpp).
  void sort_by_name() {
    const std::vector<core::Rigid3> as_read = std::move(found_.graph.world_from_node);
    found_.names.clear();
    found_.graph.world_from_node.clear();
    for (auto& [name, node] : node_of_) {
      found_.graph.world_from_node.push_back(as_read[static_cast<std::size_t>(node)]);
      node = static_cast<int>(found_.names.size());
      found_.names.push_back(name);
    }
  }

  Ends ends_of(const core::TextLine& line) const {
    if (line.words.size() != 3)
      refuse(line, fmt::format("found {} values, expected 2, the vertices", line.words.size() - 1));
    return undirected(node_of(line, 1), node_of(line, 2));
  }

  void note_odometry(const core::TextLine& line) { ++num_odometry_[ends_of(line)]; }
  void note_loop(const core::TextLine& line) { num_odometry_.try_emplace(ends_of(line), 0); }

  // A landmark that was left out may be fixed.
  void fix(const core::TextLine& line) {
    if (line.words.size() < 2) name_of(line, 1);
    for (std::size_t column = 1; column < line.words.size(); ++column)
      if (!others_.contains(line.words[column]))
        found_.graph.fixed_nodes.push_back(node_of(line, column));
  }

  void add_edge(const core::TextLine& line, const Kind& kind) {
    const auto num_entries =
        static_cast<std::size_t>(kind.num_degrees * (kind.num_degrees + 1) / 2);
    expect(line, 3 + kind.num_pose + num_entries, kind);
    PoseEdge edge{node_of(line, 1), node_of(line, 2), pose_of(line, 3, kind)};
    if (edge.a == edge.b)
      refuse(line, fmt::format("joins {} to itself, expected two vertices", line.words[1]));
    edge.information = information_of(line, edge, kind);
    edge.is_loop = is_loop(undirected(edge.a, edge.b));
    found_.graph.edges.push_back(edge);
  }

  static Ends undirected(int a, int b) { return std::minmax(a, b); }

  // Between a number and the next one that is there, the first edge is odometry, as every program
  // writes it.
  bool is_loop(const Ends& ends) {
    const int left = num_odometry_.try_emplace(ends, follows(ends) ? 1 : 0).first->second--;
    return left <= 0;
  }

  bool follows(const Ends& ends) const {
    const auto robot_of = [&](int node) {
      return found_.names[static_cast<std::size_t>(node)] >> kRobotBits;
    };
    return ends.second - ends.first == 1 && robot_of(ends.first) == robot_of(ends.second);
  }

  // The number of words, and that a file is either planar or not.
  void expect(const core::TextLine& line, std::size_t num_words, const Kind& kind) {
    if (line.words.size() != num_words) {
      refuse(line, fmt::format("found {} values, expected {} of {}", line.words.size() - 1,
                               num_words - 1, line.words.front()));
    }
    if (!kind_) kind_ = &kind;
    if (kind_ != &kind) {
      refuse(line, fmt::format("found {}, expected all of one kind, {} and {} as above",
                               line.words.front(), kind_->vertex, kind_->edge));
    }
    found_.graph.is_planar = kind.is_planar;
  }

  static long name_of(const core::TextLine& line, std::size_t column) {
    if (column >= line.words.size()) refuse(line, "found no number, expected that of a vertex");
    const std::string& word = line.words[column];
    long name = 0;
    const char* const end = word.data() + word.size();
    const char* const begin = word.data() + (word.size() > 1 && word.front() == '+' ? 1 : 0);
    const auto [last, error] = std::from_chars(begin, end, name);
    if (error != std::errc{} || last != end || name < 0) {
      refuse(line, fmt::format("found '{}', expected the number of a vertex, 0 or more",
                               core::printable(word)));
    }
    return name;
  }

  int node_of(const core::TextLine& line, std::size_t column) const {
    const long name = name_of(line, column);
    const auto node = node_of_.find(name);
    if (node == node_of_.end())
      refuse(line, fmt::format("names vertex {}, expected one that the file has", name));
    return node->second;
  }

  static core::Rigid3 pose_of(const core::TextLine& line, std::size_t first, const Kind& kind) {
    std::vector<double> v;
    for (std::size_t i = 0; i < kind.num_pose; ++i) {
      v.push_back(core::finite_number(line, first + i));
      if (std::abs(v.back()) > kMaxNumber) {
        refuse(line, fmt::format("found {}, expected a pose of metres and radians, {:g} at most",
                                 line.words[first + i], kMaxNumber));
      }
    }
    if (kind.is_planar) return {core::exp_so3({0.0, 0.0, v[2]}), {v[0], v[1], 0.0}};
    Eigen::Quaterniond rotation(v[6], v[3], v[4], v[5]);
    if (std::abs(rotation.norm() - 1.0) > kMaxNormError)
      refuse(line, fmt::format("quaternion of norm {:.4g}, expected 1", rotation.norm()));
    rotation.normalize();
    return {rotation, {v[0], v[1], v[2]}};
  }

  core::Matrix6d information_of(const core::TextLine& line, const PoseEdge& edge,
                                const Kind& kind) {
    Eigen::MatrixXd given(kind.num_degrees, kind.num_degrees);
    std::size_t column = 3 + kind.num_pose;
    for (int row = 0; row < kind.num_degrees; ++row) {
      for (int i = row; i < kind.num_degrees; ++i)
        given(row, i) = given(i, row) = core::finite_number(line, column++);
    }
    if (!is_definite(given)) given = projected(line, given);
    const core::Matrix6d information = kind.is_planar ? lifted(given, edge) : turned(given, edge);
    // turned by the measurement, it may be indefinite by rounding
    return is_definite(information) ? information : core::Matrix6d(projected(line, information));
  }

  static bool is_definite(const Eigen::MatrixXd& matrix) {
    return Eigen::LLT<Eigen::MatrixXd>(matrix).info() == Eigen::Success;
  }

  // Where an edge measures nothing (its information has a direction of 0, or below by rounding), it
  // gets next to nothing. What is clearly indefinite is refused: a sign or the order is wrong.
  Eigen::MatrixXd projected(const core::TextLine& line, const Eigen::MatrixXd& given) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(given);
    const Eigen::VectorXd& values = solver.eigenvalues();
    const double largest = values(values.size() - 1);
    if (solver.info() != Eigen::Success || !(largest > 0.0) ||
        values(0) < -kMaxNegative * largest) {
      refuse(line, fmt::format("an information that is not positive definite (eigenvalues {:.3g} "
                               "to {:.3g}), expected one that is",
                               values(0), largest));
    }
    if (projected_.empty() || projected_.back() != line.place) projected_.push_back(line.place);
    const Eigen::MatrixXd usable = solver.eigenvectors() *
                                   values.cwiseMax(kLeastShare * largest).asDiagonal() *
                                   solver.eigenvectors().transpose();
    return 0.5 * (usable + usable.transpose());
  }

  void warn_of_projected(const std::filesystem::path& path) const {
    if (projected_.empty()) return;
    spdlog::warn(
        "{}: an information with a direction of 0, raised to {:g} of its largest; {} edges of {} "
        "are so, this is the first",
        projected_.front(), kLeastShare, projected_.size(), path.filename().string());
  }

  // For our error in place of g2o's, see g2o_information.
  static core::Matrix6d turned(const core::Matrix6d& given, const PoseEdge& edge) {
    core::Matrix6d g2o_from_ours = core::Matrix6d::Zero();
    g2o_from_ours.topLeftCorner<3, 3>() = edge.a_from_b.rotation.conjugate().toRotationMatrix();
    g2o_from_ours.bottomRightCorner<3, 3>() = 0.5 * Eigen::Matrix3d::Identity();
    return g2o_from_ours.transpose() * given * g2o_from_ours;
  }

  // What holds the pose in the plane is as strong as the rest: its error is always 0.
  static core::Matrix6d lifted(const Eigen::Matrix3d& given, const PoseEdge& edge) {
    Eigen::Matrix3d g2o_from_ours = edge.a_from_b.rotation.conjugate().toRotationMatrix();
    const Eigen::Matrix3d planar = g2o_from_ours.transpose() * given * g2o_from_ours;
    core::Matrix6d full = given.trace() / 3.0 * core::Matrix6d::Identity();
    full(kPlanarRows, kPlanarRows) = planar;
    return full;
  }

  G2oGraph found_;
  std::map<long, int> node_of_;
  std::vector<std::pair<core::TextLine, const Kind*>> edges_;
  std::map<Ends, int> num_odometry_;  // still to come
  std::vector<core::TextLine> odometry_;
  std::vector<core::TextLine> loops_;
  std::set<std::string> others_;        // vertices of types that are left out
  std::vector<std::string> projected_;  // lines whose information was
  std::vector<core::TextLine> fixed_;
  const Kind* kind_ = nullptr;
};

}  // namespace

G2oGraph read_g2o(const std::filesystem::path& path) { return Reader(path).take(); }

}  // namespace samewhere::optimize
