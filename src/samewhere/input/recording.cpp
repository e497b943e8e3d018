#include <string>

#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/recording.hpp>

namespace samewhere::input {

void keep_first_camera(Recording& recording) {
  for (FrameFiles& frame : recording.frames) frame.images.resize(1);
}

bool read_own_rig(const Config& config, Recording& recording, const std::function<void()>& read) {
  const bool is_replaced = !config.camera.empty();
  try {
    read();
    return true;
  } catch (const core::InputError& error) {
    if (!is_replaced && config.needs_calibration)
      throw core::InputError(std::string(error.what()) + "; --camera FILE stands in for it");
    if (!is_replaced) spdlog::warn("{}; the calibration is not used", error.what());
  }
  recording.rig = {};
  const bool is_stereo = !recording.frames.empty() && recording.frames.front().images.size() > 1;
  if (is_stereo && is_replaced)
    spdlog::warn("the second camera is not used: the recording has no calibration of it");
  keep_first_camera(recording);
  return false;
}

}  // namespace samewhere::input
