#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <samewhere/twin/building/figures.hpp>
#include <samewhere/twin/building/surface.hpp>

namespace samewhere::twin {

// A person that walks to and fro along a path, on the right side of it.
class Person {
 public:
  // Points on the floor, at least two, metres. Looks, pace and where they are at 0 s follow from
  // the seed.
  Person(const std::vector<Eigen::Vector3d>& path_m, std::uint64_t seed);

  // What there is to see of them at a time.
  std::vector<Rectangle> at(double stamp_s) const;
  // Where they stand, on the floor.
  Eigen::Vector3d position_m(double stamp_s) const;

 private:
  Eigen::Vector3d smooth_point(double distance_m) const;
  Eigen::Vector3d point(double distance_m) const;
  double distance_m(double stamp_s) const { return start_m_ + speed_m_s_ * stamp_s; }

  std::vector<Eigen::Vector3d> round_m_;  // there and back again, closed
  std::vector<double> reached_m_;         // distance from the first point at each
  double speed_m_s_ = 1.2;
  double start_m_ = 0.0;
  Look look_;
};

// Several people, spread over the paths in turn.
std::vector<Person> people_on(const std::vector<std::vector<Eigen::Vector3d>>& paths_m, int count,
                              std::uint64_t seed);
// All of them, as Renderer::render wants it.
std::vector<Rectangle> rectangles_of(const std::vector<Person>& people, double stamp_s);

}  // namespace samewhere::twin
