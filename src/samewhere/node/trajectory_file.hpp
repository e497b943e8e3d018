#pragma once

#include <filesystem>
#include <vector>

#include <samewhere/slam.hpp>

namespace samewhere::node {

// Poses of the camera in the map as a TUM file. Throws core::InputError if it cannot be written.
void write_trajectory(const std::filesystem::path& path, const std::vector<StampedPose>& poses);

}  // namespace samewhere::node
