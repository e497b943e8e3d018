#pragma once

#include <string>

#include <samewhere/run/export_model.hpp>

namespace samewhere::run {

// The three files of a COLMAP model. Ids count from 1 in the order of the model; the only camera is
// 1. The centre of the upper left pixel is (0.5, 0.5), poses are camera_from_world with qw first.
// Source: COLMAP 3.8, "Output Format".
struct ColmapFiles {
  std::string cameras;
  std::string images;
  std::string points;
};

// "PINHOLE", "OPENCV" or, with k3, "FULL_OPENCV".
const char* colmap_camera_model(const core::PinholeRadtan& camera);

ColmapFiles colmap_text(const ExportedModel& model);
ColmapFiles colmap_binary(const ExportedModel& model);

}  // namespace samewhere::run
