#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/file_names.hpp>
#include <samewhere/input/numbered.hpp>

namespace samewhere::input {

void stamp_by_number(std::vector<FrameFiles>& frames, double fps) {
  const FrameFiles* last = nullptr;
  int last_number = -1;
  for (FrameFiles& frame : frames) {
    const std::optional<int> number = frame_number(frame.name);
    if (!number) {
      throw core::InputError(frame.images.front().string() +
                             ": has no frame number (of at most nine digits) in its name");
    }
    if (last != nullptr && *number <= last_number) {
      throw core::InputError(
          fmt::format("{}: has frame number {} after {} of {}, expected numbers that rise",
                      frame.images.front().string(), *number, last_number, last->name));
    }
    frame.stamp_s = *number / fps;
    last_number = *number;
    last = &frame;
  }
}

void attach_depth(std::vector<FrameFiles>& frames,
                  const std::vector<std::filesystem::path>& depths) {
  core::require(frames.size() == depths.size(), "there is one depth path per frame");
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!is_there(depths[i])) {
      throw core::InputError(fmt::format("{}: does not exist, expected the depth image of {}",
                                         depths[i].string(), frames[i].name));
    }
    frames[i].depth = depths[i];
  }
}

}  // namespace samewhere::input
