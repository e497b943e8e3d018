#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <samewhere/bags/bag.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/input/bag_source.hpp>
#include <samewhere/input/camera_file.hpp>
#include <samewhere/input/file_names.hpp>
#include <samewhere/input/file_source.hpp>
#include <samewhere/input/formats.hpp>
#include <samewhere/input/image_file.hpp>
#include <samewhere/input/open.hpp>
#include <samewhere/input/place_matrix.hpp>
#include <samewhere/input/video.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using std::filesystem::path;

// 0 means "the format's own"; what lies between is a slip of the pen.
void check_config(const Config& config) {
  if (config.fps != 0.0 && config.fps < 1e-3) {
    throw InputError(fmt::format("input.fps = {}: expected 0 or at least 0.001", config.fps));
  }
  if (config.depth_factor != 0.0 && config.depth_factor < 1.0) {
    throw InputError(
        fmt::format("input.depth_factor = {}: expected 0 or at least 1", config.depth_factor));
  }
}

[[noreturn]] void fail_unknown(const path& folder) {
  const std::vector<std::string> names = sorted_names(folder);
  if (names.empty()) {
    throw InputError(folder.string() + ": the folder is empty, expected a recording");
  }
  for (const std::string& name : names) {
    if (!name.starts_with("seq-") || !is_folder(folder / name)) continue;
    throw InputError(fmt::format("{}: holds several sequences, expected one, such as {}",
                                 folder.string(), (folder / name).string()));
  }
  throw InputError(
      folder.string() +
      ": holds no known recording; looked for rgb.txt (TUM RGB-D), mav0/ (EuRoC), "
      "image_0/ or image_2/ with times.txt (KITTI), frame-*.color.png or .jpg "
      "(7-Scenes), images/ with depth/, K.txt or poses.txt "
      "(HoloLens), color.txt (OpenLORIS), FRONTAL/ (Rawseeds), day_left/ (GardensPoint), Images/, "
      "rgb/ or color/ with depth/, *.jpg, *.jpeg, *.png or other pictures");
}

Recording read_folder(const path& folder, const Config& config) {
  for (const auto& find :
       {&find_tum_rgbd, &find_open_loris, &find_euroc, &find_kitti, &find_seven_scenes,
        &find_rawseeds, &find_gardens_point, &find_place_set, &find_hololens,
        &find_colour_and_depth, &find_images, &find_picture_folders}) {
    std::optional<Recording> recording = find(folder, config);
    if (!recording) continue;
    add_published_places(folder, config, *recording);
    return *std::move(recording);
  }
  fail_unknown(folder);
}

std::string beginning_of(const path& file) {
  constexpr std::size_t kNumBytes = 4096;
  return core::read_beginning(file, kNumBytes);
}

// Text has no control characters but white space. (UTF-16 has zeros; core::read_text refuses it.)
bool is_text(std::string_view bytes) {
  const auto is_control = [](char c) {
    return (c >= 0 && c < ' ' && !(c >= '\t' && c <= '\r')) || c == '\x7f';
  };
  return std::none_of(bytes.begin(), bytes.end(), is_control);
}

bool is_wide_text(std::string_view bytes) {
  return bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff");
}

Recording read_list(const path& list, const Config& config) {
  const std::string bytes = beginning_of(list);
  if (!is_text(bytes) && !is_wide_text(bytes)) {
    throw InputError(list.string() +
                     (is_picture(bytes) ? ": is one picture" : ": is a binary file") +
                     ", expected a folder, a text file with the path of one image a line, or a "
                     "video (.mp4, .avi, ...)");
  }
  return read_image_list(list, config);
}

// The last part of the path, also for "data/redkitchen/" and ".".
std::string name_of(const path& source) {
  std::error_code error;  // on an error the path is empty, and so is the name
  const path whole = std::filesystem::canonical(source, error);
  if (!is_folder(whole)) return whole.stem().string();
  // all EuRoC recordings call their only folder the same
  return (whole.filename() == "mav0" ? whole.parent_path() : whole).filename().string();
}

void require_there(const path& source) {
  if (is_there(source)) return;
  throw InputError(
      source.string() +
      ": does not exist, expected a folder with a recording, a list of images, a video, "
      "a bag (.mcap, .db3, .bag) or a camera such as /dev/video0");
}

}  // namespace

Recording read_recording(const path& source, const Config& config) {
  check_config(config);
  require_there(source);
  Recording recording = is_folder(source) ? read_folder(source, config) : read_list(source, config);
  if (!config.camera.empty()) recording.camera_file = config.camera;
  recording.needs_calibration = config.needs_calibration || !config.camera.empty();
  if (config.depth_factor > 0.0) {
    recording.depth_units_per_m = config.depth_factor;
  } else if (const auto told = depth_units_per_m_of(recording.camera_file)) {
    recording.depth_units_per_m = *told;
  }
  if (!config.depth) {
    for (FrameFiles& files : recording.frames) files.depth.clear();
  }
  return recording;
}

bool is_video(const path& source) {
  if (!is_there(source) || is_folder(source) || bags::is_bag(source)) return false;
  if (is_camera_device(source) || is_video_name(source.string())) return true;
  const std::string bytes = beginning_of(source);
  return !is_text(bytes) && !is_wide_text(bytes) && !is_picture(bytes);
}

std::unique_ptr<core::Source> open_source(const path& source, const Config& config) {
  require_there(source);
  if (bags::is_bag(source)) {
    check_config(config);
    return open_bag_source(source, config);
  }
  if (is_video(source)) {
    check_config(config);
    return open_video(source, config);
  }
  return std::make_unique<FileSource>(name_of(source), read_recording(source, config));
}

}  // namespace samewhere::input
