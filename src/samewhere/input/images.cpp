#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/text_file.hpp>
#include <samewhere/input/file_names.hpp>
#include <samewhere/input/formats.hpp>
#include <samewhere/input/numbered.hpp>
#include <samewhere/input/truth_file.hpp>

namespace samewhere::input {
namespace {

using std::filesystem::path;

constexpr double kFps = 30.0;

double fps_of(const Config& config) { return config.fps > 0.0 ? config.fps : kFps; }

void stamp_by_position(std::vector<FrameFiles>& frames, double fps) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].stamp_s = static_cast<double>(i) / fps;
  }
}

bool numbers_rise(const std::vector<FrameFiles>& frames) {
  int last = -1;
  for (const FrameFiles& frame : frames) {
    const int number = frame_number(frame.name).value_or(-1);
    if (number <= last) return false;
    last = number;
  }
  return true;
}

}  // namespace

std::optional<Recording> find_images(const path& folder, const Config& config) {
  Recording recording{.format = "images"};
  for (const std::string& name : sorted_names(folder)) {
    if (is_image_name(name)) recording.frames.push_back({name, 0.0, {folder / name}});
  }
  if (recording.frames.empty()) return std::nullopt;
  if (numbers_rise(recording.frames)) {
    stamp_by_number(recording.frames, fps_of(config));
  } else {
    stamp_by_position(recording.frames, fps_of(config));
  }
  if (is_there(folder / "camera.txt")) recording.camera_file = folder / "camera.txt";
  recording.truth = read_truth(folder, static_cast<int>(recording.frames.size()));
  return recording;
}

Recording read_image_list(const path& list, const Config& config) {
  Recording recording{.format = "image list"};
  for (const core::TextLine& line : core::read_text_lines(list)) {
    const std::string& name = line.words.front();
    const path image = list.parent_path() / name;
    if (!is_there(image)) {
      throw core::InputError(fmt::format("{}: the image {} does not exist", line.place, name));
    }
    recording.frames.push_back({name, 0.0, {image}});
  }
  if (recording.frames.empty()) throw core::InputError(list.string() + ": lists no image");
  stamp_by_position(recording.frames, fps_of(config));
  return recording;
}

}  // namespace samewhere::input
