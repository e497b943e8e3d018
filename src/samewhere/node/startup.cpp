#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/message_image.hpp>
#include <samewhere/input/stereo_pair.hpp>
#include <samewhere/library/convert.hpp>
#include <samewhere/node/startup.hpp>
#include <samewhere/node/transforms.hpp>

namespace samewhere::node {
namespace {

// Frames whose median interval is the frame period.
constexpr std::size_t kFramesForRate = 8;

Camera interface_camera(const core::Camera& camera) {
  return std::visit(
      [&](const auto& c) { return library::camera_of(camera, c.width_px, c.height_px); }, camera);
}

}  // namespace

Startup::Startup(Config config) : config_(std::move(config)) {}

void Startup::take_info(Stream stream, const messages::CameraInfo& info) {
  std::optional<CalibratedCamera>& known = stream == Stream::kFirst ? first_ : second_;
  if (known) return;
  const std::string name = stream == Stream::kFirst ? "camera_info" : "right/camera_info";
  const auto camera = input::camera_of(info, config_.is_rectified, name);
  if (!camera) throw core::InputError(name + ": focal length 0; expected a calibrated camera");
  known = CalibratedCamera{interface_camera(*camera), info, *camera};
}

std::uint64_t Startup::add(FrameSet frame) {
  if (!first_stamp_s_) first_stamp_s_ = frame.first.stamp_s;
  frames_.push_back(std::move(frame));
  const std::size_t capacity =
      std::max(kFramesForRate, static_cast<std::size_t>(config_.queue_frames));
  if (frames_.size() <= capacity) return 0;
  frames_.pop_front();
  return 1;
}

std::deque<FrameSet> Startup::take_frames() { return std::exchange(frames_, {}); }

std::optional<double> Startup::frame_rate_hz() const {
  if (config_.frame_rate_hz > 0.0) return config_.frame_rate_hz;
  if (frames_.size() < kFramesForRate) return std::nullopt;
  std::vector<double> periods_s;
  for (std::size_t i = 1; i < frames_.size(); ++i)
    periods_s.push_back(frames_[i].first.stamp_s - frames_[i - 1].first.stamp_s);
  const auto middle = periods_s.begin() + static_cast<std::ptrdiff_t>(periods_s.size() / 2);
  std::nth_element(periods_s.begin(), middle, periods_s.end());
  if (!(*middle > 0.0)) return std::nullopt;
  // cameras are named by whole numbers
  constexpr double kRounding = 0.02;
  const double rate_hz = 1.0 / *middle;
  const double whole_hz = std::round(rate_hz);
  return std::abs(rate_hz - whole_hz) < kRounding * rate_hz ? whole_hz : rate_hz;
}

bool Startup::may_wait() const {
  return frames_.back().first.stamp_s - *first_stamp_s_ < config_.tf_wait_s;
}

Result<Setup, std::string> Startup::place_of_camera(const input::Transforms& transforms) const {
  const std::string camera_frame = input::frame_name(frames_.back().first.frame_id);
  if (const auto pose = transforms.fixed(camera_frame, config_.base_frame)) {
    return Setup{.calibration = {},
                 .base_frame = config_.base_frame,
                 .camera_from_base = library::pose_of(*pose)};
  }
  if (may_wait()) {
    return refuse(
        fmt::format("waiting for /tf_static: {} to {}", config_.base_frame, camera_frame));
  }
  const input::Transforms::Root root = transforms.fixed_root_of(camera_frame);
  return Setup{.calibration = {},
               .base_frame = root.name.empty() ? "camera" : root.name,
               .camera_from_base = library::pose_of(core::inverse(root.root_from_frame))};
}

Result<Pose, std::string> Startup::place_of_right_camera(
    const input::Transforms& transforms) const {
  const auto told = input::left_from_right(first_->info, second_->info, config_.is_rectified);
  if (told) return library::pose_of(*told);
  const std::string left = input::frame_name(frames_.back().first.frame_id);
  const std::string right = input::frame_name(frames_.back().second->frame_id);
  const bool are_apart = left != right && !config_.is_rectified;
  const auto fixed = transforms.fixed(left, right);
  if (are_apart && fixed) return library::pose_of(*fixed);
  if (are_apart && may_wait())
    return refuse(fmt::format("waiting for /tf_static: {} to {}", left, right));
  throw core::InputError("right/camera_info: " + told.error());
}

Result<Setup, std::string> Startup::setup(const input::Transforms& transforms) const {
  const bool is_stereo = config_.cameras == Cameras::kStereo;
  if (frames_.empty()) return refuse(std::string("waiting for images"));
  if (!first_) return refuse(std::string("waiting for camera_info"));
  if (is_stereo && !second_) return refuse(std::string("waiting for right/camera_info"));
  const std::optional<double> rate_hz = frame_rate_hz();
  if (!rate_hz) return refuse(std::string("measuring the frame rate"));
  auto setup = place_of_camera(transforms);
  if (!setup) return setup;
  Camera left = first_->camera;
  // where the base is the camera itself, the map has the axes of a robot all the same
  const bool is_camera = setup->base_frame == input::frame_name(frames_.back().first.frame_id);
  left.body_from_camera = is_camera ? body_from_optical() : setup->camera_from_base.inverse();
  setup->first_camera = first_->model;
  setup->calibration = {.cameras = {left},
                        .has_depth = config_.cameras == Cameras::kDepth,
                        .frame_rate_hz = *rate_hz};
  if (is_stereo) {
    const auto left_from_right = place_of_right_camera(transforms);
    if (!left_from_right) return refuse(left_from_right.error());
    Camera right = second_->camera;
    right.body_from_camera = left.body_from_camera * *left_from_right;
    setup->calibration.cameras.push_back(right);
  }
  return setup;
}

}  // namespace samewhere::node
