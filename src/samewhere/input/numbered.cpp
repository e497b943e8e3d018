#include <algorithm>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/file_names.hpp>
#include <samewhere/input/left_out.hpp>
#include <samewhere/input/numbered.hpp>
#include <samewhere/input/truth_file.hpp>

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
  LeftOut left_out;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (is_there(depths[i])) {
      frames[i].depth = depths[i];
    } else {
      left_out.add(fmt::format("{}: does not exist, expected the depth image of {}",
                               depths[i].string(), frames[i].name));
    }
  }
  left_out.refuse_most(frames.size(), "depth images");
  left_out.warn(frames.size(), "depth images");
}

core::Trajectory read_pose_lines(
    const std::filesystem::path& file, const std::vector<FrameFiles>& frames,
    const std::function<core::Rigid3(const core::TextLine&)>& pose_of) {
  core::Trajectory trajectory;
  read_if_sound("the run goes on without this ground truth", [&] {
    const std::vector<core::TextLine> lines = core::read_text_lines(file);
    LeftOut left_out;
    for (std::size_t i = 0; i < std::min(lines.size(), frames.size()); ++i) {
      try {
        trajectory.push_back({frames[i].stamp_s, pose_of(lines[i])});
      } catch (const core::InputError& error) {
        left_out.add(error.what());
      }
    }
    left_out.warn(lines.size(), "poses of the ground truth");
    if (lines.size() != frames.size()) {
      spdlog::warn("{}: found {} poses, expected {}, one a frame; the first of them are used",
                   file.string(), lines.size(), frames.size());
    }
  });
  return trajectory;
}

}  // namespace samewhere::input
