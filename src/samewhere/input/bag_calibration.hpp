#pragma once

#include <filesystem>

#include <samewhere/core/rig.hpp>
#include <samewhere/input/bag_opening.hpp>

namespace samewhere::input {

// The cameras and the IMU of a recording. The body is camera 0, in the axes of its optical frame;
// config.camera replaces its calibration. The right camera hangs on it by the calibrations of the
// pair (R, P), or else by /tf_static; the IMU by /tf_static. A right camera or an IMU of which
// neither tells is not in the rig; of the camera the log says so. No cameras: the recording has no
// calibration. Throws InputError for one that cannot be used; the rig is empty then, with a
// warning, where the calibration is not needed (config.needs_calibration).
core::Rig read_rig(const std::filesystem::path& file, bags::BagReader& bag,
                   const BagOpening& opening, const Config& config);

}  // namespace samewhere::input
