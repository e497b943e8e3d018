#include <algorithm>
#include <cmath>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/twin/motion/people.hpp>

namespace samewhere::twin {
namespace {

constexpr double kRightOfPath_m = 0.42;
constexpr double kSmoothing_m = 0.45;  // half the stretch over which corners are rounded

// Points of the path moved to the right in walking direction.
std::vector<Eigen::Vector3d> right_side(const std::vector<Eigen::Vector3d>& points_m) {
  std::vector<Eigen::Vector3d> moved_m;
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    const Eigen::Vector3d& before = points_m[i > 0 ? i - 1 : 0];
    const Eigen::Vector3d& after = points_m[std::min(i + 1, points_m.size() - 1)];
    const Eigen::Vector2d along = (after - before).head<2>().normalized();
    moved_m.push_back(points_m[i] + kRightOfPath_m * Eigen::Vector3d(along.y(), -along.x(), 0.0));
  }
  return moved_m;
}

}  // namespace

Person::Person(const std::vector<Eigen::Vector3d>& path_m, std::uint64_t seed)
    : look_(look_of(core::seed_of(seed, "twin.look", 0))) {
  core::require(path_m.size() >= 2, "a person's path has two points or more");
  const std::vector<Eigen::Vector3d> back_m(path_m.rbegin(), path_m.rend());
  round_m_ = right_side(path_m);
  const std::vector<Eigen::Vector3d> returning_m = right_side(back_m);
  round_m_.insert(round_m_.end(), returning_m.begin(), returning_m.end());
  round_m_.push_back(round_m_.front());
  reached_m_.push_back(0.0);
  for (std::size_t i = 1; i < round_m_.size(); ++i) {
    reached_m_.push_back(reached_m_.back() + (round_m_[i] - round_m_[i - 1]).norm());
  }
  core::Random random(core::seed_of(seed, "twin.person", 0));
  speed_m_s_ = random.uniform(0.95, 1.35);
  start_m_ = random.uniform(0.0, reached_m_.back());
}

// At a distance of any size along the round.
Eigen::Vector3d Person::point(double distance_m) const {
  const double total_m = reached_m_.back();
  const double on_round_m = distance_m - total_m * std::floor(distance_m / total_m);
  const auto next = std::upper_bound(reached_m_.begin() + 1, reached_m_.end() - 1, on_round_m);
  const auto i = static_cast<std::size_t>(next - reached_m_.begin());
  const double length_m = reached_m_[i] - reached_m_[i - 1];
  const double ratio = length_m > 0.0 ? (on_round_m - reached_m_[i - 1]) / length_m : 0.0;
  return round_m_[i - 1] + ratio * (round_m_[i] - round_m_[i - 1]);
}

// A mean over a stretch: corners and ends are walked as bends.
Eigen::Vector3d Person::smooth_point(double distance_m) const {
  constexpr int kHalfSamples = 6;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = -kHalfSamples; i <= kHalfSamples; ++i) {
    sum += point(distance_m + kSmoothing_m * i / kHalfSamples);
  }
  return sum / (2 * kHalfSamples + 1);
}

Eigen::Vector3d Person::position_m(double stamp_s) const {
  return smooth_point(distance_m(stamp_s));
}

std::vector<Rectangle> Person::at(double stamp_s) const {
  constexpr double kHeadingReach_m = 0.15;
  const double walked_m = distance_m(stamp_s);
  const Eigen::Vector3d ahead =
      smooth_point(walked_m + kHeadingReach_m) - smooth_point(walked_m - kHeadingReach_m);
  const auto heading_rad = static_cast<float>(std::atan2(ahead.y(), ahead.x()));
  return figure(look_, static_cast<float>(walked_m) / stride_m(look_),
                smooth_point(walked_m).cast<float>(), heading_rad);
}

std::vector<Person> people_on(const std::vector<std::vector<Eigen::Vector3d>>& paths_m, int count,
                              std::uint64_t seed) {
  core::require(count == 0 || !paths_m.empty(), "people need a path to walk along");
  std::vector<Person> people;
  for (int i = 0; i < count; ++i) {
    const auto index = static_cast<std::size_t>(i);
    people.emplace_back(paths_m[index % paths_m.size()], core::seed_of(seed, "twin.people", index));
  }
  return people;
}

std::vector<Rectangle> rectangles_of(const std::vector<Person>& people, double stamp_s) {
  std::vector<Rectangle> all;
  for (const auto& person : people) {
    const std::vector<Rectangle> one = person.at(stamp_s);
    all.insert(all.end(), one.begin(), one.end());
  }
  return all;
}

}  // namespace samewhere::twin
