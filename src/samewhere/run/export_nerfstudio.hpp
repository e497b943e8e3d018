#pragma once

#include <string>
#include <vector>

#include <samewhere/run/export_model.hpp>

namespace samewhere::run {

// Names of folders and files, relative to that of transforms.json.
struct NerfstudioNames {
  std::string images;
  std::string depth;
  std::string points;
};

// transforms.json of nerfstudio: intrinsics of all pictures with the centre of the upper left pixel
// at (0.5, 0.5); of each its path, that of its depth where `has_depth` says that there is some, and
// transform_matrix, world_from_camera with OpenGL's axes (x right, y up, z back). The world keeps
// its axes. Source: nerfstudio 1.1, "Data conventions".
std::string transforms_json(const ExportedModel& model, const std::vector<bool>& has_depth,
                            const NerfstudioNames& names);

}  // namespace samewhere::run
