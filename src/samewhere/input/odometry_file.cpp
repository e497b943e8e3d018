#include <cmath>
#include <string>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include <samewhere/bags/bag.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file_kind.hpp>
#include <samewhere/core/text_file.hpp>
#include <samewhere/input/bag_poses.hpp>
#include <samewhere/input/odometry_file.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using core::TextLine;

constexpr std::size_t kPose = 8;                 // stamp tx ty tz qx qy qz qw
constexpr std::size_t kWithVariances = 14;       // and 6 variances
constexpr std::size_t kWithCovariance = 8 + 21;  // and the upper triangle

void require_columns(const TextLine& line, std::size_t num_columns, std::size_t of_first) {
  const bool is_known =
      num_columns == kPose || num_columns == kWithVariances || num_columns == kWithCovariance;
  if (!is_known) {
    throw InputError(fmt::format(
        "{}: found {} columns, expected 8 (stamp tx ty tz qx qy qz qw), 14 (and 6 variances) or 29 "
        "(and the 21 numbers of the upper triangle of a covariance)",
        line.place, num_columns));
  }
  if (num_columns != of_first) {
    throw InputError(fmt::format("{}: found {} columns, expected {} as in the first row",
                                 line.place, num_columns, of_first));
  }
}

core::Rigid3 pose_of(const TextLine& line, const std::vector<double>& numbers) {
  constexpr double kMaxRounding = 0.01;
  const Eigen::Quaterniond rotation(numbers[7], numbers[4], numbers[5], numbers[6]);
  if (!(std::abs(rotation.norm() - 1.0) <= kMaxRounding)) {
    throw InputError(fmt::format("{}: found a quaternion of norm {:.6g}, expected norm 1",
                                 line.place, rotation.norm()));
  }
  return {rotation.normalized(), {numbers[1], numbers[2], numbers[3]}};
}

core::Matrix6d covariance_of(const TextLine& line, const std::vector<double>& numbers) {
  core::Matrix6d covariance = core::Matrix6d::Zero();
  std::size_t next = kPose;
  for (int row = 0; row < 6; ++row) {
    const int end = numbers.size() == kWithVariances ? row + 1 : 6;
    for (int column = row; column < end; ++column)
      covariance(row, column) = covariance(column, row) = numbers[next++];
    if (covariance(row, row) < 0.0) {
      throw InputError(fmt::format("{}: found the variance {:.6g}, expected none below 0",
                                   line.place, covariance(row, row)));
    }
  }
  constexpr double kRounding = 1e-6;  // files round
  const Eigen::SelfAdjointEigenSolver<core::Matrix6d> solver(covariance, Eigen::EigenvaluesOnly);
  const double least = solver.eigenvalues()(0);
  if (least < -kRounding * solver.eigenvalues()(5)) {
    throw InputError(
        fmt::format("{}: found a matrix with the eigenvalue {:.6g}, expected a covariance, which "
                    "has none below 0",
                    line.place, least));
  }
  return covariance;
}

}  // namespace

OdometryRows read_odometry(const std::filesystem::path& path, const std::string& topics) {
  if (core::is_there(path) && bags::is_bag(path)) return read_bag_odometry(path, topics);
  std::vector<TextLine> lines = core::read_text_lines(path);
  core::drop_column_names(lines);
  OdometryRows rows;
  std::size_t num_columns = 0;
  for (const TextLine& line : lines) {
    const TextLine values{line.place, core::words_between_commas(line.text)};
    if (rows.empty()) num_columns = values.words.size();
    require_columns(line, values.words.size(), num_columns);
    const std::vector<double> numbers =
        core::finite_numbers(values, num_columns, "an odometry row");
    OdometryRow row{numbers[0], pose_of(line, numbers), std::nullopt};
    if (num_columns != kPose) row.covariance = covariance_of(line, numbers);
    if (!rows.empty() && row.stamp_s <= rows.back().stamp_s) {
      throw InputError(fmt::format("{}: found stamp {:.6f} after {:.6f}, expected stamps that rise",
                                   line.place, row.stamp_s, rows.back().stamp_s));
    }
    rows.push_back(std::move(row));
  }
  if (rows.empty()) {
    throw InputError(path.string() +
                     ": has no row, expected lines `stamp tx ty tz qx qy qz qw` of odometry");
  }
  rows.front().covariance.reset();
  return rows;
}

}  // namespace samewhere::input
