#pragma once

#include <filesystem>

#include <samewhere/core/rig.hpp>

namespace samewhere::input {

// The sensor.yaml files of a EuRoC recording (Burri et al. 2016, "The EuRoC micro aerial vehicle
// datasets"). Each reader throws InputError naming file, line and key if an entry is missing or is
// not what it has to be. T_BS is body from sensor.

struct EurocCamera {
  core::Camera camera;
  core::Rigid3 body_from_camera;
};

// camera_model pinhole with distortion_model radial-tangential (radtan, plumb_bob), rational,
// equidistant (a fisheye) or none; other models are refused.
EurocCamera read_euroc_camera(const std::filesystem::path& file);

// Random walks that the file does not tell are 0.
core::Imu read_euroc_imu(const std::filesystem::path& file);

// Of any sensor.
core::Rigid3 read_euroc_body_from_sensor(const std::filesystem::path& file);

}  // namespace samewhere::input
