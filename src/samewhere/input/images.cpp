#include <initializer_list>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/text_file.hpp>
#include <samewhere/input/depth_folder.hpp>
#include <samewhere/input/file_names.hpp>
#include <samewhere/input/formats.hpp>
#include <samewhere/input/left_out.hpp>
#include <samewhere/input/list_file.hpp>
#include <samewhere/input/name_stamps.hpp>
#include <samewhere/input/truth_file.hpp>

namespace samewhere::input {
namespace {

using std::filesystem::path;

constexpr double kFps = 30.0;

double fps_of(const Config& config) { return config.fps > 0.0 ? config.fps : kFps; }

std::vector<FrameFiles> pictures_of(const path& folder, const Config& config) {
  const std::vector<std::string> names = picture_names(folder);
  if (names.empty()) return {};
  const NameStamps stamps = stamps_from_names(names, fps_of(config), config.fps > 0.0);
  if (!stamps.remark.empty()) spdlog::warn("{}: {}", folder.string(), stamps.remark);
  std::vector<FrameFiles> frames;
  for (std::size_t i = 0; i < names.size(); ++i)
    frames.push_back({names[i], stamps.stamps_s[i], {folder / names[i]}});
  return frames;
}

// The first of the folders that is there; empty: none is.
path first_folder(const path& folder, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    if (is_folder(folder / name)) return folder / name;
  }
  return {};
}

path depth_folder(const path& folder) {
  return first_folder(folder, {"depth", "depths", "depth_images", "Depth"});
}

}  // namespace

std::optional<Recording> find_images(const path& folder, const Config& config) {
  Recording recording{.format = "images", .frames = pictures_of(folder, config)};
  if (recording.frames.empty()) return std::nullopt;
  if (is_there(folder / "camera.txt")) recording.camera_file = folder / "camera.txt";
  recording.truth = read_truth(folder, static_cast<int>(recording.frames.size()));
  return recording;
}

std::optional<Recording> find_picture_folders(const path& folder, const Config& config) {
  const path colour = first_folder(folder, {"rgb", "color", "colour", "image", "images", "Images",
                                            "rgb_images", "color_images", "RGB"});
  if (colour.empty()) return std::nullopt;
  const path depth = depth_folder(folder);
  Recording recording{.format = depth.empty() ? "images" : "colour and depth folders",
                      .frames = pictures_of(colour, config)};
  if (recording.frames.empty()) return std::nullopt;
  if (config.depth && !depth.empty())
    attach_depth_folder(depth, config.max_stamp_difference_s, recording.frames);
  for (const path& file : {colour / "camera.txt", folder / "K.txt", folder / "camera.txt"}) {
    if (is_there(file)) recording.camera_file = file;
  }
  recording.truth = read_truth(folder, static_cast<int>(recording.frames.size()));
  if (is_there(folder / "groundtruth.txt"))
    recording.truth.trajectory = read_true_trajectory(folder / "groundtruth.txt");
  return recording;
}

std::optional<Recording> find_colour_and_depth(const path& folder, const Config& config) {
  return depth_folder(folder).empty() ? std::nullopt : find_picture_folders(folder, config);
}

Recording read_image_list(const path& list, const Config& config) {
  Recording recording{.format = "image list"};
  LeftOut left_out;
  const std::vector<core::TextLine> lines = core::read_text_lines(list);
  for (const core::TextLine& line : lines) {
    const ListedFile file = listed_file(list.parent_path(), line.text);
    if (file.is_there) {
      recording.frames.push_back({file.name, 0.0, {file.path}});
    } else {
      left_out.add(fmt::format("{}: the image {} does not exist", line.place, file.name));
    }
  }
  if (lines.empty()) throw core::InputError(list.string() + ": lists no image");
  left_out.refuse_most(lines.size(), "images");
  left_out.warn(lines.size(), "images");
  for (std::size_t i = 0; i < recording.frames.size(); ++i)
    recording.frames[i].stamp_s = static_cast<double>(i) / fps_of(config);
  return recording;
}

}  // namespace samewhere::input
