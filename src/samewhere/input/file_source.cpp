#include <algorithm>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/camera_file.hpp>
#include <samewhere/input/file_source.hpp>
#include <samewhere/input/image_file.hpp>

namespace samewhere::input {
namespace {

using core::InputError;

core::Rig rig_of(const Recording& recording, int width_px, int height_px) {
  if (recording.camera_file.empty()) return {};
  core::PinholeRadtan camera = read_camera_file(recording.camera_file);
  camera.width_px = width_px;
  camera.height_px = height_px;
  const bool is_inside = camera.cx_px >= 0.0 && camera.cx_px <= width_px - 1.0 &&
                         camera.cy_px >= 0.0 && camera.cy_px <= height_px - 1.0;
  if (!is_inside) {
    throw InputError(fmt::format(
        "{}: wrong calibration: the centre ({}, {}) lies outside the image, {} is {} x {} pixels",
        recording.camera_file.string(), camera.cx_px, camera.cy_px,
        recording.frames.front().image.string(), width_px, height_px));
  }
  return {.cameras = {camera}, .body_from_camera = {core::Rigid3{}}, .imu = std::nullopt};
}

void check_size(const std::filesystem::path& file, const cv::Mat& image, int width_px,
                int height_px) {
  if (image.cols == width_px && image.rows == height_px) return;
  throw InputError(fmt::format("{}: is {} x {} pixels, expected {} x {} as the first image",
                               file.string(), image.cols, image.rows, width_px, height_px));
}

double frame_rate_hz(const std::vector<FrameFiles>& frames) {
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    steps_s.push_back(frames[i].stamp_s - frames[i - 1].stamp_s);
  }
  if (steps_s.empty()) return 0.0;
  const auto middle = steps_s.begin() + static_cast<std::ptrdiff_t>(steps_s.size() / 2);
  std::nth_element(steps_s.begin(), middle, steps_s.end());
  return 1.0 / *middle;
}

}  // namespace

FileSource::FileSource(std::string name, Recording recording) : recording_(std::move(recording)) {
  core::require(!recording_.frames.empty(), "a recording holds at least one frame");
  const cv::Mat first = read_image(recording_.frames.front().image);
  width_px_ = first.cols;
  height_px_ = first.rows;
  rig_ = std::make_shared<const core::Rig>(rig_of(recording_, width_px_, height_px_));
  const bool has_depth = std::any_of(recording_.frames.begin(), recording_.frames.end(),
                                     [](const FrameFiles& files) { return !files.depth.empty(); });
  info_ = {.name = std::move(name),
           .format = recording_.format,
           .num_frames = static_cast<int>(recording_.frames.size()),
           .has_depth = has_depth,
           .is_calibrated = rig_->is_calibrated(),
           .frame_rate_hz = frame_rate_hz(recording_.frames)};
}

core::SourceInfo FileSource::info() const { return info_; }

std::optional<core::Frame> FileSource::next() {
  if (next_index_ == recording_.frames.size()) return std::nullopt;
  const FrameFiles& files = recording_.frames[next_index_];
  core::Frame frame;
  frame.id = core::FrameId(next_index_);
  frame.stamp_s = files.stamp_s;
  frame.name = files.name;
  frame.rig = rig_;
  frame.images.push_back(read_image(files.image));
  check_size(files.image, frame.images.front(), width_px_, height_px_);
  if (!files.depth.empty()) {
    frame.depth_m = read_depth(files.depth, recording_.depth_units_per_m);
    check_size(files.depth, *frame.depth_m, width_px_, height_px_);
  }
  ++next_index_;
  return frame;
}

}  // namespace samewhere::input
