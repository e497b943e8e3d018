#include <algorithm>
#include <iterator>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/tum_file.hpp>

namespace samewhere::core {

namespace {

std::string first_words(std::string_view text, std::size_t count) {
  std::vector<std::string> words = words_between_commas(text);
  words.resize(std::min(words.size(), count));
  return fmt::format("{}", fmt::join(words, " "));
}

}  // namespace

StampedPose tum_pose(const TextLine& line) {
  const TextLine values{line.place, words_between_commas(line.text)};
  const std::vector<double> n = finite_numbers(values, 8, "stamp tx ty tz qx qy qz qw");
  const Eigen::Quaterniond rotation(n[7], n[4], n[5], n[6]);
  constexpr double kMinNorm = 1e-6;
  if (!(rotation.norm() >= kMinNorm && rotation.norm() <= 1.0 / kMinNorm)) {
    throw InputError(fmt::format("{}: found a quaternion of norm {}, expected a unit quaternion",
                                 line.place, rotation.norm()));
  }
  return {n[0], {rotation.normalized(), {n[1], n[2], n[3]}}};
}

Trajectory read_tum(const std::filesystem::path& path, MoreColumns more) {
  Trajectory trajectory;
  for (TextLine line : read_text_lines(path)) {
    if (more == MoreColumns::kSkipped) line.text = first_words(line.text, 8);
    const StampedPose pose = tum_pose(line);
    if (!trajectory.empty() && pose.stamp_s <= trajectory.back().stamp_s) {
      throw InputError(fmt::format("{}: found stamp {:.6f} after {:.6f}, expected stamps that rise",
                                   line.place, pose.stamp_s, trajectory.back().stamp_s));
    }
    trajectory.push_back(pose);
  }
  return trajectory;
}

std::string tum_text(const Trajectory& trajectory) {
  std::string text;
  for (const StampedPose& pose : trajectory) {
    const Eigen::Vector3d& t = pose.world_from_camera.translation;
    const Eigen::Quaterniond& q = pose.world_from_camera.rotation;
    fmt::format_to(std::back_inserter(text),
                   "{:.6f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}\n", pose.stamp_s, t.x(),
                   t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
  }
  return text;
}

}  // namespace samewhere::core
