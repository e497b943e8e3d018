#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <sstream>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/evaluate/degraded_odometry.hpp>

namespace samewhere::evaluate {
namespace {

constexpr double kLeastRatio = 0.01;
constexpr double kReference_m = 100.0;  // over which a share of the distance holds
constexpr double kMetresPerSlip = 10.0;
constexpr double kOutage_s = 5.0;
constexpr double kSecondsPerOutage = 60.0;
constexpr double kRadians = std::numbers::pi / 180.0;

core::InputError not_a_kind(const std::string& word) {
  return core::InputError(fmt::format(
      "--degrade {}: expected a share of the distance (5%), a heading drift (1deg/m), slip, outage "
      "or lift, or several joined by +",
      word));
}

// "5%" with the unit "%" is 5; nothing with another unit.
std::optional<double> amount(const std::string& word, const std::string& unit, double most) {
  if (!word.ends_with(unit)) return std::nullopt;
  const char* end = word.data() + word.size() - unit.size();
  double number = 0.0;
  const auto read = std::from_chars(word.data(), end, number);
  if (read.ec != std::errc() || read.ptr != end || !(number > 0.0 && number <= most))
    throw not_a_kind(word);
  return number;
}

void add_kind(const std::string& word, Degradation& degradation) {
  if (const auto percent = amount(word, "%", 100.0)) {
    degradation.distance_ratio = *percent / 100.0;
  } else if (const auto degrees = amount(word, "deg/m", 45.0)) {
    degradation.rad_per_metre = *degrees * kRadians;
  } else if (word == "slip") {
    degradation.has_slips = true;
  } else if (word == "outage") {
    degradation.has_outages = true;
  } else if (word == "lift") {
    degradation.is_without_height = true;
  } else {
    throw not_a_kind(word);
  }
}

// The axis of the world about which the body turns most: the vertical of what moves upright.
Eigen::Vector3d axis_of_turns(const core::Trajectory& truth) {
  Eigen::Matrix3d turns = Eigen::Matrix3d::Zero();
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const Eigen::Quaterniond& before = truth[i - 1].world_from_camera.rotation;
    const Eigen::Vector3d turn =
        before * core::log_so3(before.conjugate() * truth[i].world_from_camera.rotation);
    if (turn.norm() > 0.0) turns += turn * turn.transpose() / turn.norm();
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(turns).eigenvectors().col(2);
}

double sign(core::Random& random) { return random.index(2) == 0 ? -1.0 : 1.0; }

// Constant and random errors of one run.
class Errors {
 public:
  Errors(const Degradation& degradation, std::uint64_t seed)
      : degradation_(degradation), random_(core::seed_of(seed, "degraded odometry", 0)) {
    const double share = degradation.distance_ratio / std::numbers::sqrt2;
    scale_ = sign(random_) * share;
    // at the end of the reference the heading has moved the position by the same share
    heading_ = sign(random_) * (2.0 * share / kReference_m + degradation.rad_per_metre);
    noise_ = 0.2 * degradation.distance_ratio;
    heading_noise_ = 0.02 * degradation.distance_ratio + 0.1 * degradation.rad_per_metre;
  }

  // `up`: in the body before.
  core::Rigid3 measured(const core::Rigid3& before_from_after, const Eigen::Vector3d& up) {
    core::Rigid3 step = before_from_after;
    const double length_m = step.translation.norm();
    const double root = std::sqrt(length_m);
    step.translation *= 1.0 + scale_ + slip(length_m);
    Eigen::Vector3d noise(random_.gaussian(), random_.gaussian(), random_.gaussian());
    noise -= up * up.dot(noise);
    step.translation += noise_ * root * noise;
    if (degradation_.is_without_height) step.translation -= up * up.dot(step.translation);
    const double turned = heading_ * length_m + heading_noise_ * root * random_.gaussian();
    step.rotation = step.rotation * core::exp_so3(turned * (step.rotation.conjugate() * up));
    return step;
  }

 private:
  double slip(double length_m) {
    if (!degradation_.has_slips) return 0.0;
    if (rest_m_ <= 0.0 && random_.uniform() < length_m / kMetresPerSlip) {
      rest_m_ = random_.uniform(0.5, 1.5);
      slip_ = sign(random_) * random_.uniform(0.3, 1.0);
    }
    rest_m_ -= length_m;
    return rest_m_ + length_m > 0.0 ? slip_ : 0.0;
  }

  Degradation degradation_;
  core::Random random_;
  double scale_ = 0.0;
  double heading_ = 0.0;
  double noise_ = 0.0;
  double heading_noise_ = 0.0;
  double rest_m_ = 0.0;  // of a slip
  double slip_ = 0.0;
};

// Not at either end, so that the rows before and after show the gap.
core::Trajectory with_outages(core::Trajectory rows, std::uint64_t seed) {
  core::Random random(core::seed_of(seed, "odometry outage", 0));
  const double first_s = rows.front().stamp_s + 1.0;
  const double last_s = rows.back().stamp_s - kOutage_s - 1.0;
  if (last_s <= first_s) return rows;
  const auto count = std::max(1L, std::lround((last_s - first_s) / kSecondsPerOutage));
  for (long i = 0; i < count; ++i) {
    const double begin_s = random.uniform(first_s, last_s);
    std::erase_if(rows, [&](const core::StampedPose& row) {
      return row.stamp_s > begin_s && row.stamp_s < begin_s + kOutage_s;
    });
  }
  return rows;
}

}  // namespace

Degradation degradation_of(const std::string& kinds) {
  Degradation degradation;
  std::istringstream words(kinds);
  std::string word;
  while (std::getline(words, word, '+')) add_kind(word, degradation);
  if (kinds.empty() || kinds.ends_with('+')) throw not_a_kind(kinds);
  return degradation;
}

core::Trajectory degraded(const core::Trajectory& truth, Degradation degradation,
                          std::uint64_t seed) {
  if (truth.empty()) return {};
  degradation.distance_ratio =
      degradation.distance_ratio == 0.0 ? kLeastRatio : degradation.distance_ratio;
  const Eigen::Vector3d up_in_world = axis_of_turns(truth);
  Errors errors(degradation, seed);
  core::Trajectory rows = {truth.front()};
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const core::Rigid3& before = truth[i - 1].world_from_camera;
    const core::Rigid3 step = errors.measured(inverse(before) * truth[i].world_from_camera,
                                              before.rotation.conjugate() * up_in_world);
    rows.push_back({truth[i].stamp_s, rows.back().world_from_camera * step});
  }
  return degradation.has_outages ? with_outages(std::move(rows), seed) : rows;
}

}  // namespace samewhere::evaluate
