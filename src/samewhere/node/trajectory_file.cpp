#include <samewhere/core/file.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/library/convert.hpp>
#include <samewhere/node/trajectory_file.hpp>

namespace samewhere::node {

void write_trajectory(const std::filesystem::path& path, const std::vector<StampedPose>& poses) {
  core::Trajectory trajectory;
  for (const StampedPose& pose : poses)
    trajectory.push_back({pose.stamp_s, library::rigid_of(pose.map_from_camera)});
  core::write_file(path, core::tum_text(trajectory));
}

}  // namespace samewhere::node
