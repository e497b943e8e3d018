#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/median.hpp>
#include <samewhere/core/nanoseconds.hpp>
#include <samewhere/geometry/camera_check.hpp>
#include <samewhere/input/camera_file.hpp>
#include <samewhere/input/depth_check.hpp>
#include <samewhere/input/exif.hpp>
#include <samewhere/input/file_source.hpp>
#include <samewhere/input/image_file.hpp>

namespace samewhere::input {
namespace {

using core::InputError;

// A camera of a format that does not say how large its pictures are.
core::Camera camera_of_size(const core::Camera& unsized_camera, const cv::Size& size_px,
                            const std::filesystem::path& image) {
  core::Camera camera = with_size(unsized_camera, size_px);
  const auto fault = geometry::fault_of(camera);
  if (!fault) return camera;
  throw InputError(fmt::format("{}: wrong calibration of its camera: {}", image.string(), *fault));
}

cv::Size size_of(const core::Camera& camera) {
  return std::visit([](const auto& model) { return cv::Size(model.width_px, model.height_px); },
                    camera);
}

core::Rig rig_of(const Recording& recording, const std::vector<cv::Size>& sizes_px) {
  const std::vector<std::filesystem::path>& images = recording.frames.front().images;
  core::Rig rig = recording.rig;
  if (!recording.camera_file.empty()) {
    if (rig.cameras.empty()) rig.body_from_camera = {core::Rigid3{}};
    rig.cameras.resize(std::max<std::size_t>(rig.cameras.size(), 1));
    rig.cameras.front() =
        read_camera_file_for(recording.camera_file, sizes_px.front(), images.front());
  }
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const cv::Size calibrated_px = size_of(rig.cameras[i]);
    if (calibrated_px.empty()) {
      rig.cameras[i] = camera_of_size(rig.cameras[i], sizes_px[i], images[i]);
    } else if (calibrated_px != sizes_px[i]) {
      throw InputError(fmt::format("{}: is {} x {} pixels, its camera is calibrated for {} x {}",
                                   images[i].string(), sizes_px[i].width, sizes_px[i].height,
                                   calibrated_px.width, calibrated_px.height));
    }
  }
  return rig;
}

// None where the recording goes on without one.
core::Rig rig_if_needed(Recording& recording, const std::vector<cv::Size>& sizes_px) {
  try {
    return rig_of(recording, sizes_px);
  } catch (const InputError& error) {
    if (recording.needs_calibration) throw;
    spdlog::warn("{}; the calibration is not used", error.what());
  }
  keep_first_camera(recording);
  return {};
}

// A calibration is that of the sensor, and pictures are used as the sensor gave them.
void warn_of_rotation(const std::filesystem::path& image) {
  const int orientation = exif_orientation(core::read_file(image, core::kPictureLimit));
  if (orientation <= 1) return;
  spdlog::warn(
      "{}: is noted to be turned or mirrored (EXIF orientation {}); the pictures are used as they "
      "are stored, and the calibration has to be of such pictures",
      image.string(), orientation);
}

void check_size(const std::filesystem::path& file, const cv::Mat& image, const cv::Size& size_px) {
  if (image.size() == size_px) return;
  throw InputError(fmt::format("{}: is {} x {} pixels, expected {} x {} as the first image",
                               file.string(), image.cols, image.rows, size_px.width,
                               size_px.height));
}

double frame_rate_hz(const std::vector<FrameFiles>& frames) {
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    steps_s.push_back(frames[i].stamp_s - frames[i - 1].stamp_s);
  }
  const auto step_s = core::median(std::move(steps_s));
  return step_s ? 1.0 / *step_s : 0.0;
}

// Spread evenly over those that have one.
std::vector<std::filesystem::path> some_depth_files(const std::vector<FrameFiles>& frames) {
  constexpr std::size_t kMost = 5;
  std::vector<std::filesystem::path> all;
  for (const FrameFiles& files : frames)
    if (!files.depth.empty()) all.push_back(files.depth);
  if (all.size() <= kMost) return all;
  std::vector<std::filesystem::path> some;
  for (std::size_t i = 0; i < kMost; ++i) some.push_back(all[i * (all.size() - 1) / (kMost - 1)]);
  return some;
}

void warn_of_depth(const Recording& recording) {
  const std::vector<std::filesystem::path> files = some_depth_files(recording.frames);
  std::vector<cv::Mat> depths_m;
  for (const std::filesystem::path& file : files) {
    try {
      depths_m.push_back(read_depth(file, recording.depth_units_per_m));
    } catch (const InputError&) {
      // told when its frame is due
    }
  }
  if (const auto doubt = doubt_about_depth(depths_m, recording.depth_units_per_m)) {
    spdlog::warn("{} and {} others: {}", files.front().string(), files.size() - 1, *doubt);
  }
}

}  // namespace

FileSource::FileSource(std::string name, Recording recording) : recording_(std::move(recording)) {
  core::require(!recording_.frames.empty(), "a recording holds at least one frame");
  // as a bag of the same recording has them: a position divided by a rate is none of them
  for (FrameFiles& files : recording_.frames)
    files.stamp_s = core::in_whole_nanoseconds(files.stamp_s);
  for (core::StampedPose& pose : recording_.truth.trajectory)
    pose.stamp_s = core::in_whole_nanoseconds(pose.stamp_s);
  for (core::InertialTruth& state : recording_.truth.inertial)
    state.stamp_s = core::in_whole_nanoseconds(state.stamp_s);
  for (const auto& image : recording_.frames.front().images) {
    sizes_px_.push_back(read_image(image).size());
  }
  core::require(recording_.rig.cameras.empty() || recording_.rig.cameras.size() == sizes_px_.size(),
                "a calibrated recording has one image per camera");
  warn_of_rotation(recording_.frames.front().images.front());
  rig_ = std::make_shared<const core::Rig>(rig_if_needed(recording_, sizes_px_));
  sizes_px_.resize(recording_.frames.front().images.size());
  const bool has_depth = std::any_of(recording_.frames.begin(), recording_.frames.end(),
                                     [](const FrameFiles& files) { return !files.depth.empty(); });
  info_ = {.name = std::move(name),
           .format = recording_.format,
           .num_frames = static_cast<int>(recording_.frames.size()),
           .has_depth = has_depth,
           .num_cameras = static_cast<int>(sizes_px_.size()),
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
  for (std::size_t i = 0; i < files.images.size(); ++i) {
    frame.images.push_back(read_image(files.images[i]));
    check_size(files.images[i], frame.images.back(), sizes_px_[i]);
  }
  if (!files.depth.empty()) {
    frame.depth_m = read_depth(files.depth, recording_.depth_units_per_m);
    check_size(files.depth, *frame.depth_m, sizes_px_.front());
    if (!std::exchange(is_depth_checked_, true)) warn_of_depth(recording_);
  }
  const auto& imu = recording_.imu;
  for (; next_imu_ < imu.size() && imu[next_imu_].stamp_s <= files.stamp_s; ++next_imu_) {
    frame.imu_since_last.push_back(imu[next_imu_]);
  }
  ++next_index_;
  return frame;
}

}  // namespace samewhere::input
