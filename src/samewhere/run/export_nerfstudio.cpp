#include <nlohmann/json.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/run/export_nerfstudio.hpp>
#include <samewhere/run/export_pictures.hpp>

namespace samewhere::run {
namespace {

using NerfJson = nlohmann::ordered_json;

NerfJson nerfstudio_camera(const core::PinholeRadtan& c) {
  constexpr double kHalfPixel = 0.5;
  NerfJson json = {{"camera_model", has_distortion(c) ? "OPENCV" : "PINHOLE"},
                   {"w", c.width_px},
                   {"h", c.height_px},
                   {"fl_x", c.fx_px},
                   {"fl_y", c.fy_px},
                   {"cx", c.cx_px + kHalfPixel},
                   {"cy", c.cy_px + kHalfPixel}};
  if (has_distortion(c))
    json.update({{"k1", c.k1}, {"k2", c.k2}, {"k3", c.k3}, {"p1", c.p1}, {"p2", c.p2}});
  return json;
}

NerfJson opengl_matrix(const core::Rigid3& world_from_camera) {
  Eigen::Matrix4d world_from_opengl = world_from_camera.matrix();
  world_from_opengl.block<3, 2>(0, 1) *= -1.0;  // y up, z back
  NerfJson rows = NerfJson::array();
  for (int i = 0; i < 4; ++i) {
    NerfJson row = NerfJson::array();
    for (int k = 0; k < 4; ++k) row.push_back(world_from_opengl(i, k));
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace

std::string transforms_json(const ExportedModel& model, const std::vector<bool>& has_depth,
                            const NerfstudioNames& names) {
  core::require(has_depth.size() == model.views.size(), "each view has depth or not");
  NerfJson json = nerfstudio_camera(model.camera);
  json["ply_file_path"] = names.points;
  NerfJson frames = NerfJson::array();
  for (std::size_t i = 0; i < model.views.size(); ++i) {
    const std::string name = picture_name(model.views[i].frame);
    NerfJson frame = {{"file_path", names.images + "/" + name}};
    if (has_depth[i]) frame["depth_file_path"] = names.depth + "/" + name;
    frame["transform_matrix"] = opengl_matrix(model.views[i].world_from_camera);
    frames.push_back(std::move(frame));
  }
  json["frames"] = std::move(frames);
  return json.dump(1) + "\n";
}

}  // namespace samewhere::run
