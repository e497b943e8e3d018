#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <samewhere/optimize/manifold.hpp>
#include <samewhere/optimize/schur.hpp>

namespace samewhere::optimize {
namespace {

using core::Matrix6d;
using core::Vector6d;
using Matrix63d = Eigen::Matrix<double, 6, 3>;

constexpr double kFunctionTolerance = 1e-5;  // relative decrease of the cost that ends the work
constexpr double kStartDamping = 1e-4;       // of the diagonal
constexpr double kMaxDamping = 1e8;
constexpr double kMinDiagonal = 1e-6;  // damped as if it had at least this much curvature
constexpr double kMaxDiagonal = 1e32;

// The Huber loss of a squared residual and its derivative; without robustness the square itself.
struct Loss {
  double value = 0.0;
  double weight = 1.0;
};

Loss loss_of(const Reprojection& r, bool is_robust) {
  const bool is_behind = r.size == 0;
  const double square = is_behind ? kErrorBehind * kErrorBehind : r.value.squaredNorm();
  const double threshold = kChiSquare95[is_behind ? 2 : r.size];
  if (!is_robust || square <= threshold) return {square, 1.0};
  const double ratio = std::sqrt(threshold / square);
  return {2.0 * square * ratio - threshold, ratio};
}

// An observation in the work: whose it is and its share of the normal equations.
struct Term {
  std::size_t observation = 0;
  int camera = 0;
  int free_camera = -1;  // position among the free ones; -1 = fixed
  Matrix63d by_both = Matrix63d::Zero();
};

struct PointTerms {
  std::size_t point = 0;
  std::size_t begin = 0;  // of its terms
  std::size_t end = 0;
  Eigen::Matrix3d curvature = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();  // of the damped curvature
};

template <typename Vector>
Vector damping_of(const Vector& diagonal, double damping) {
  return damping * diagonal.cwiseMax(kMinDiagonal).cwiseMin(kMaxDiagonal);
}

// All sums run over points in their order and over the observations of a point in the order of
// cameras: the same bits each time.
class Schur {
 public:
  Schur(BundleState& state, bool is_robust) : state_(state), is_robust_(is_robust) {
    number_cameras();
    group_by_point();
  }

  int minimise(int max_iterations);

 private:
  void number_cameras();
  void group_by_point();
  void linearise();
  void linearise(PointTerms& point);
  bool solve_step();
  void reduce(PointTerms& point);
  void step_points();
  double predicted_decrease() const;
  BundleState moved() const;
  // Sum of the losses, a half of it as Ceres counts.
  double cost(const BundleState& state) const;

  BundleState& state_;
  bool is_robust_;
  std::vector<int> free_cameras_;    // positions in the problem
  std::vector<Term> terms_;          // by point
  std::vector<PointTerms> points_;   // those with terms
  std::vector<Matrix6d> curvature_;  // one per free camera
  std::vector<Vector6d> gradient_;   // one per free camera
  Eigen::MatrixXd reduced_;          // upper blocks of the reduced camera system
  Eigen::VectorXd reduced_gradient_;
  Eigen::VectorXd camera_step_;
  std::vector<Eigen::Vector3d> point_step_;  // one per entry of points_
  double damping_ = kStartDamping;
};

void Schur::number_cameras() {
  const auto& cameras = state_.problem->cameras;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (!cameras[i].is_fixed) free_cameras_.push_back(static_cast<int>(i));
  }
}

void Schur::group_by_point() {
  const auto& observations = state_.problem->observations;
  std::vector<int> free_of(state_.problem->cameras.size(), -1);
  for (std::size_t i = 0; i < free_cameras_.size(); ++i)
    free_of[static_cast<std::size_t>(free_cameras_[i])] = static_cast<int>(i);
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (!state_.is_used[i]) continue;
    const int camera = observations[i].camera;
    terms_.push_back({i, camera, free_of[static_cast<std::size_t>(camera)]});
  }
  const auto key = [&](const Term& t) {
    return std::pair(observations[t.observation].point, t.camera);
  };
  std::stable_sort(terms_.begin(), terms_.end(),
                   [&](const Term& a, const Term& b) { return key(a) < key(b); });
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    const auto point = static_cast<std::size_t>(observations[terms_[i].observation].point);
    if (points_.empty() || points_.back().point != point) points_.push_back({point, i, i});
    points_.back().end = i + 1;
  }
}

void Schur::linearise() {
  curvature_.assign(free_cameras_.size(), Matrix6d::Zero());
  gradient_.assign(free_cameras_.size(), Vector6d::Zero());
  for (auto& point : points_) linearise(point);
}

void Schur::linearise(PointTerms& point) {
  point.curvature.setZero();
  point.gradient.setZero();
  for (std::size_t i = point.begin; i < point.end; ++i) {
    Term& term = terms_[i];
    const auto camera = static_cast<std::size_t>(term.camera);
    const BundleResidual r = bundle_residual(
        state_.problem->cameras[camera], state_.camera_from_world[camera],
        state_.points_in_world[point.point], state_.problem->observations[term.observation].seen);
    const double weight = loss_of(r.reprojection, is_robust_).weight;
    const Eigen::Matrix3d weighted = weight * r.by_point;
    point.curvature += weighted.transpose() * r.by_point;
    point.gradient += weighted.transpose() * r.reprojection.value;
    if (term.free_camera < 0) continue;
    const auto free = static_cast<std::size_t>(term.free_camera);
    term.by_both = r.by_pose.transpose() * weighted;
    curvature_[free] += weight * (r.by_pose.transpose() * r.by_pose);
    gradient_[free] += weight * (r.by_pose.transpose() * r.reprojection.value);
  }
}

// Takes a point out of the system: what is left joins the cameras that see it.
void Schur::reduce(PointTerms& point) {
  Eigen::Matrix3d damped = point.curvature;
  damped.diagonal() += damping_of<Eigen::Vector3d>(point.curvature.diagonal(), damping_);
  point.inverse = damped.inverse();
  for (std::size_t i = point.begin; i < point.end; ++i) {
    const Term& first = terms_[i];
    if (first.free_camera < 0) continue;
    const Matrix63d through = first.by_both * point.inverse;
    const Eigen::Index row = 6 * static_cast<Eigen::Index>(first.free_camera);
    reduced_gradient_.segment<6>(row) -= through * point.gradient;
    for (std::size_t k = i; k < point.end; ++k) {
      const Term& second = terms_[k];
      if (second.free_camera < 0) continue;
      const Eigen::Index column = 6 * static_cast<Eigen::Index>(second.free_camera);
      reduced_.block<6, 6>(row, column).noalias() -= through * second.by_both.transpose();
    }
  }
}

// False if the damped system has no solution.
bool Schur::solve_step() {
  const auto size = 6 * static_cast<Eigen::Index>(free_cameras_.size());
  reduced_.setZero(size, size);
  reduced_gradient_.resize(size);
  for (std::size_t i = 0; i < free_cameras_.size(); ++i) {
    const Eigen::Index row = 6 * static_cast<Eigen::Index>(i);
    auto block = reduced_.block<6, 6>(row, row);
    block = curvature_[i];
    block.diagonal() += damping_of<Vector6d>(curvature_[i].diagonal(), damping_);
    reduced_gradient_.segment<6>(row) = gradient_[i];
  }
  for (auto& point : points_) reduce(point);
  camera_step_.resize(size);
  if (size > 0) {
    const auto factor = reduced_.selfadjointView<Eigen::Upper>().llt();
    if (factor.info() != Eigen::Success) return false;
    camera_step_ = factor.solve(-reduced_gradient_);
  }
  step_points();
  return camera_step_.allFinite();
}

void Schur::step_points() {
  point_step_.clear();
  for (const auto& point : points_) {
    Eigen::Vector3d gradient = point.gradient;
    for (std::size_t i = point.begin; i < point.end; ++i) {
      const Term& term = terms_[i];
      if (term.free_camera < 0) continue;
      const Eigen::Index row = 6 * static_cast<Eigen::Index>(term.free_camera);
      gradient += term.by_both.transpose() * camera_step_.segment<6>(row);
    }
    point_step_.emplace_back(-(point.inverse * gradient));
  }
}

// By the quadratic model: half of step' (damping step - gradient).
double Schur::predicted_decrease() const {
  double twice = 0.0;
  for (std::size_t i = 0; i < free_cameras_.size(); ++i) {
    const Vector6d step = camera_step_.segment<6>(6 * static_cast<Eigen::Index>(i));
    const Vector6d damping = damping_of<Vector6d>(curvature_[i].diagonal(), damping_);
    twice += step.dot(damping.cwiseProduct(step) - gradient_[i]);
  }
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Eigen::Vector3d& step = point_step_[i];
    const Eigen::Vector3d damping =
        damping_of<Eigen::Vector3d>(points_[i].curvature.diagonal(), damping_);
    twice += step.dot(damping.cwiseProduct(step) - points_[i].gradient);
  }
  return 0.5 * twice;
}

BundleState Schur::moved() const {
  BundleState moved = state_;
  for (std::size_t i = 0; i < free_cameras_.size(); ++i) {
    auto& pose = moved.camera_from_world[static_cast<std::size_t>(free_cameras_[i])];
    pose = retract(pose, camera_step_.segment<6>(6 * static_cast<Eigen::Index>(i)));
  }
  for (std::size_t i = 0; i < points_.size(); ++i)
    moved.points_in_world[points_[i].point] += point_step_[i];
  return moved;
}

double Schur::cost(const BundleState& state) const {
  double sum = 0.0;
  for (const auto& point : points_) {
    for (std::size_t i = point.begin; i < point.end; ++i) {
      const auto camera = static_cast<std::size_t>(terms_[i].camera);
      const BundleCamera& from = state.problem->cameras[camera];
      const Reprojection r =
          reproject(from.intrinsics, from.baseline_m,
                    state.camera_from_world[camera] * state.points_in_world[point.point],
                    state.problem->observations[terms_[i].observation].seen);
      sum += loss_of(r, is_robust_).value;
    }
  }
  return 0.5 * sum;
}

int Schur::minimise(int max_iterations) {
  if (points_.empty()) return 0;
  double current = cost(state_);
  linearise();
  double growth = 2.0;
  int iteration = 0;
  while (iteration < max_iterations && damping_ < kMaxDamping) {
    ++iteration;
    std::optional<double> next;
    BundleState candidate;
    if (solve_step()) {
      candidate = moved();
      next = cost(candidate);
    }
    if (!next || !(*next <= current)) {
      damping_ *= growth;
      growth *= 2.0;
      continue;
    }
    const double gain = (current - *next) / std::max(predicted_decrease(), 1e-300);
    damping_ *= std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * gain - 1.0, 3));
    growth = 2.0;
    const bool is_done = current - *next <= kFunctionTolerance * current;
    state_ = std::move(candidate);
    current = *next;
    if (is_done) break;
    linearise();
  }
  return iteration;
}

}  // namespace

int minimise_by_schur(BundleState& state, bool is_robust, int max_iterations) {
  return Schur(state, is_robust).minimise(max_iterations);
}

}  // namespace samewhere::optimize
