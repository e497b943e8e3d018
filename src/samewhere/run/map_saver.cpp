#include <sstream>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/report/loops.hpp>
#include <samewhere/run/map_saver.hpp>
#include <samewhere/run/run_metrics.hpp>

namespace samewhere::run {
namespace {

std::string text_of(const core::Camera& camera) {
  const auto& c = std::get<core::PinholeRadtan>(camera);
  return fmt::format(
      "{} x {} pixels, focal lengths {} {}, centre {} {}, distortion k1 {} k2 {} p1 {} p2 {} k3 {}",
      c.width_px, c.height_px, c.fx_px, c.fy_px, c.cx_px, c.cy_px, c.k1, c.k2, c.p1, c.p2, c.k3);
}

std::string text_of(const core::Rigid3& a_from_b) {
  const Eigen::Vector3d& t = a_from_b.translation;
  const Eigen::Quaterniond& q = a_from_b.rotation;
  return fmt::format("{} {} {} {} {} {} {}", t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
}

}  // namespace

scene::MapHeader map_header(const pipeline::Config& config, const core::Rig& rig,
                            std::uint64_t describer_checksum) {
  scene::MapHeader header;
  header["number of cameras"] = std::to_string(rig.cameras.size());
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    header[fmt::format("camera {}", i)] = text_of(rig.cameras[i]);
    header[fmt::format("body_from_camera {}", i)] = text_of(rig.body_from_camera[i]);
  }
  std::istringstream lines(core::config_as_yaml(config.features));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos)
      header["features." + line.substr(0, colon)] = line.substr(colon + 2);
  }
  header["describer"] = describer_figure(config.describe, describer_checksum).value;
  return header;
}

MapSaver::MapSaver(std::filesystem::path path, const pipeline::Config& config,
                   std::uint64_t describer_checksum)
    : path_(std::move(path)), config_(config), describer_checksum_(describer_checksum) {}

MapSaver::MapSaver(scene::MapFile file) : file_(std::move(file)) {}

void MapSaver::save(const scene::MapVersion& map, const pipeline::MapNews& news) {
  if (error_) return;
  scene::MapExtras extras{.frames = news.frames,
                          .descriptors = news.descriptors,
                          .ledger = {},
                          .thumbnails = news.thumbnails};
  for (const auto& row : news.rows) extras.ledger.push_back(report::ledger_row_json(row));
  try {
    if (!file_) {
      const core::Rig& rig = *map.keyframes[0].view.rig;
      file_ = scene::MapFile::create(path_, map_header(config_, rig, describer_checksum_));
    }
    file_->commit(map, extras);
  } catch (const core::InputError& error) {
    error_ = error.what();
    file_.reset();
    spdlog::warn("{}; the run goes on, its map is no longer saved", *error_);
  }
}

}  // namespace samewhere::run
