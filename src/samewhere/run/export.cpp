#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/folder_lock.hpp>
#include <samewhere/report/figure.hpp>
#include <samewhere/report/las.hpp>
#include <samewhere/report/ply.hpp>
#include <samewhere/run/export.hpp>
#include <samewhere/run/export_colmap.hpp>
#include <samewhere/run/export_mcap.hpp>
#include <samewhere/run/export_nerfstudio.hpp>
#include <samewhere/run/export_pictures.hpp>
#include <samewhere/run/export_place.hpp>
#include <samewhere/run/map_export.hpp>
#include <samewhere/run/run_folder.hpp>

namespace samewhere::run {
namespace {

using ExportFigures = std::vector<report::Figure>;

constexpr const char* kNoteEnd =
    "Lengths are metres, or map units where one camera without depth made the map. The world is "
    "the\n"
    "body of the first keyframe: with one camera x right, y down, z forward.\n"
    "`samewhere export --force` replaces this folder's export.\n";

ExportFigures file_figures(const ExportJob& job) { return {{"file", job.request.out.string()}}; }

ExportFigures write_tum(const ExportJob& job) {
  export_map(job.stored, {.tum = job.request.out, .session = job.request.session});
  return file_figures(job);
}

ExportFigures write_kitti(const ExportJob& job) {
  export_map(job.stored, {.kitti = job.request.out, .session = job.request.session});
  return file_figures(job);
}

ExportFigures write_g2o(const ExportJob& job) {
  export_map(job.stored, {.g2o = job.request.out});
  return file_figures(job);
}

ExportFigures write_ply(const ExportJob& job) {
  export_map(job.stored, {.ply = job.request.out});
  return file_figures(job);
}

ExportFigures write_mcap(const ExportJob& job) {
  const pipeline::Config config = config_of_run(job.request.run);
  const McapCounts counts = write_mcap_of_run(
      job.stored, session_of(job.stored, job.request.session), config, job.request.out);
  ExportFigures figures = file_figures(job);
  figures.push_back(report::figure("poses", "{}", counts.num_poses));
  figures.push_back(report::figure("points", "{}", counts.num_points));
  figures.push_back(report::figure("pictures", "{}", counts.num_pictures));
  figures.push_back(report::figure("verdicts", "{}", counts.num_verdicts));
  figures.push_back({"grid", counts.grid});
  return figures;
}

ExportFigures write_las(const ExportJob& job) {
  core::write_file(job.request.out, report::las_bytes(points_of(job.stored.map)));
  return file_figures(job);
}

// Keyframes with their pictures, for the formats that are folders.
struct PictureExport {
  ExportedModel model;
  WrittenPictures pictures;
};

PictureExport write_picture_export(const ExportJob& job, bool wants_depth, std::string_view note) {
  const ExportRequest& request = job.request;
  const pipeline::Config config = config_of_run(request.run);
  check_export_folder(request.out, config.source, request.replaces_earlier);
  const int session = session_of(job.stored, request.session);
  const auto keyframes = keyframes_of_session(job.stored.map, session);
  const auto begin = [&] { begin_export_folder(request.out, std::string(note) + kNoteEnd); };
  PictureExport made;
  made.pictures = write_pictures(keyframes, config,
                                 {.images = request.out / "images",
                                  .depth = wants_depth ? request.out / "depth" : "",
                                  .is_undistorted = request.is_undistorted,
                                  .begin = begin});
  made.model = model_of(job.stored.map, session, {made.pictures.size_px, request.is_undistorted});
  return made;
}

ExportFigures model_figures(const ExportJob& job, const ExportedModel& model) {
  const core::PinholeRadtan& camera = model.camera;
  return {{"folder", job.request.out.string()},
          report::figure("pictures", "{}, {} x {} pixels", model.views.size(), camera.width_px,
                         camera.height_px),
          {"camera model", colmap_camera_model(camera)},
          report::figure("points / observations", "{} / {}", model.points.size(),
                         num_observations(model)),
          report::figure("mean reprojection error", "{:.3f} px", mean_error_px(model))};
}

ExportFigures write_colmap(const ExportJob& job) {
  const ExportedModel model =
      write_picture_export(
          job, false,
          "COLMAP model in sparse/0, pictures of the keyframes in images.\n"
          "Poses are world to camera, qw first; the centre of the upper left pixel "
          "is (0.5, 0.5).\n")
          .model;
  const bool is_binary = job.request.is_binary;
  const ColmapFiles files = is_binary ? colmap_binary(model) : colmap_text(model);
  const std::string ending = is_binary ? ".bin" : ".txt";
  const std::filesystem::path folder = job.request.out / "sparse" / "0";
  core::make_writable_folder(folder);
  core::FilesTogether together;
  together.add(folder / ("cameras" + ending), files.cameras);
  together.add(folder / ("images" + ending), files.images);
  together.add(folder / ("points3D" + ending), files.points);
  together.publish();
  return model_figures(job, model);
}

ExportFigures write_nerfstudio(const ExportJob& job) {
  const PictureExport made = write_picture_export(
      job, true,
      "nerfstudio data: transforms.json, pictures of the keyframes in images, depth in depth.\n"
      "Poses are camera to world, cameras with OpenGL's axes (x right, y up, z back); the centre "
      "of\n"
      "the upper left pixel is (0.5, 0.5); depth is in millimetres along the optical axis, 0 "
      "unknown.\n");
  const NerfstudioNames names{"images", "depth", "sparse_points.ply"};
  core::FilesTogether together;
  together.add(job.request.out / names.points, report::ply_bytes(points_of(job.stored.map)));
  together.add(job.request.out / "transforms.json",
               transforms_json(made.model, made.pictures.has_depth, names));
  together.publish();
  ExportFigures figures = model_figures(job, made.model);
  figures.push_back(report::figure(
      "depth images", "{}",
      std::count(made.pictures.has_depth.begin(), made.pictures.has_depth.end(), true)));
  return figures;
}

constexpr std::array kFormats = {
    ExportFormat{"colmap", "colmap", "sparse model with tracks, pictures of the keyframes", true,
                 true, &write_colmap},
    ExportFormat{"nerfstudio", "nerfstudio", "transforms.json, pictures and depth of the keyframes",
                 true, false, &write_nerfstudio},
    ExportFormat{"mcap", "export.mcap",
                 "ROS 2 messages: TF, path, points, grid, pictures of the keyframes, verdicts",
                 false, false, &write_mcap},
    ExportFormat{"tum", "export.tum", "measured frames: stamp tx ty tz qx qy qz qw", false, false,
                 &write_tum},
    ExportFormat{"kitti", "export-kitti.txt", "the same frames without stamps: 3 x 4 matrices",
                 false, false, &write_kitti},
    ExportFormat{"g2o", "export.g2o", "pose graph of keyframes, odometry and loop closures", false,
                 false, &write_g2o},
    ExportFormat{"ply", "export.ply", "landmarks with colour", false, false, &write_ply},
    ExportFormat{"las", "export.las", "landmarks with colour, LAS 1.2", false, false, &write_las}};

const ExportFormat& format_called(const std::string& name) {
  const auto format = std::find_if(kFormats.begin(), kFormats.end(),
                                   [&](const ExportFormat& row) { return row.name == name; });
  if (format != kFormats.end()) return *format;
  std::vector<std::string> names;
  for (const ExportFormat& row : kFormats) names.emplace_back(row.name);
  throw core::InputError(
      fmt::format("--to = {}: expected one of {}", name, fmt::join(names, ", ")));
}

void require_meaning(const ExportFormat& format, const ExportRequest& request) {
  if (request.is_binary && !format.has_binary)
    throw core::InputError(
        fmt::format("--binary: has no meaning for --to {}; expected --to colmap", format.name));
  if (request.is_undistorted && !format.is_folder)
    throw core::InputError(fmt::format(
        "--undistort: has no meaning for --to {}; expected a format with pictures", format.name));
}

}  // namespace

std::span<const ExportFormat> export_formats() { return kFormats; }

std::vector<report::Figure> export_run(const std::string& format_name, const ExportRequest& asked) {
  const ExportFormat& format = format_called(format_name);
  require_meaning(format, asked);
  ExportRequest request = asked;
  std::optional<core::FolderLock> lock;  // no run may replace what is there meanwhile
  if (request.out.empty()) {
    request.out = request.run / format.default_name;
    lock.emplace(request.run);
  }
  const scene::StoredMap stored = scene::MapFile::open(request.map).load();
  if (!format.is_folder) check_export_file(request.out, request.map, request.replaces_earlier);
  return format.write({request, stored});
}

}  // namespace samewhere::run
