#include <utility>

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/printable.hpp>
#include <samewhere/input/message_image.hpp>
#include <samewhere/library/convert.hpp>
#include <samewhere/library/watched_slam.hpp>
#include <samewhere/node/node.hpp>
#include <samewhere/node/outputs.hpp>
#include <samewhere/node/transforms.hpp>

namespace samewhere::node {
namespace {

Picture picture_of(ImageIn in) {
  Picture picture;
  std::visit(
      [&](const auto& message) {
        picture.stamp_s = messages::seconds(message.header.stamp);
        picture.frame_id = message.header.frame_id;
      },
      in.message);
  picture.message = std::move(in.message);
  return picture;
}

cv::Mat image_from(const Picture& picture, const std::string& name) {
  return std::visit([&](const auto& message) { return input::image_of(message, name); },
                    picture.message);
}

cv::Mat depth_from(const Picture& picture, double units_per_m) {
  return std::visit(
      [&](const auto& message) { return input::depth_of(message, "depth", units_per_m); },
      picture.message);
}

Image view_of(const cv::Mat& image) {
  const PixelFormat format = image.type() == CV_32FC1  ? PixelFormat::kDepthFloat
                             : image.type() == CV_8UC3 ? PixelFormat::kBgr8
                                                       : PixelFormat::kGray8;
  return {.data = image.data,
          .width_px = image.cols,
          .height_px = image.rows,
          .format = format,
          .stride_bytes = image.step};
}

Options options_with(Options options, bool never_wait) {
  options.never_wait = never_wait && options.threads;
  options.on_event = nullptr;
  return options;
}

}  // namespace

Node::Node(const Config& config, const Options& options, Publisher& publisher,
           run::Watcher* watcher)
    : config_(config),
      options_(options_with(options, config.never_wait)),
      publisher_(publisher),
      watcher_(watcher),
      pairing_(config.cameras != Cameras::kMono, config.pair_tolerance_s,
               static_cast<std::size_t>(config.queue_frames)),
      startup_(config) {
  set_status("waiting for images");
}

Node::~Node() = default;

void Node::take(Incoming incoming) {
  try {
    std::visit([this](auto& in) { take_one(in); }, incoming);
  } catch (const std::exception& error) {
    refused(error.what());
  }
}

Node::Counts Node::counts() const {
  Counts counts = counts_;
  counts.num_dropped += pairing_.num_dropped();
  return counts;
}

void Node::refused(const std::string& why) {
  ++counts_.num_refused;
  counts_.last_refusal = core::printable_line(why, core::kMaxMessage);
}

void Node::take_one(ImageIn& in) {
  const Stream stream = in.stream;
  Picture picture = picture_of(std::move(in));
  if (stream == Stream::kFirst) {
    pairing_.add_first(std::move(picture));
  } else {
    pairing_.add_second(std::move(picture));
  }
  while (std::optional<FrameSet> frame = pairing_.next()) use(std::move(*frame));
}

void Node::take_one(const CameraInfoIn& in) {
  if (startup_) startup_->take_info(in.stream, in.message);
}

void Node::take_one(const OdometryIn& in) {
  const messages::Odometry& odometry = in.message;
  if (input::frame_name(odometry.header.frame_id) != config_.odom_frame ||
      input::frame_name(odometry.child_frame_id) != config_.base_frame) {
    throw core::InputError(fmt::format(
        "odometry from '{}' to '{}'; expected '{}' to '{}' (node.odom_frame, node.base_frame)",
        odometry.header.frame_id, odometry.child_frame_id, config_.odom_frame, config_.base_frame));
  }
  take_odometry(messages::seconds(odometry.header.stamp), odometry.pose.pose.position,
                odometry.pose.pose.orientation);
}

void Node::take_one(const TransformsIn& in) {
  if (in.is_static) {
    int num_unusable = 0;
    for (const messages::TransformStamped& transform : in.message.transforms)
      if (!static_transforms_.add(transform, true)) ++num_unusable;
    if (num_unusable > 0)
      refused(fmt::format("/tf_static: {} transforms are not rigid or close a ring", num_unusable));
    return;
  }
  if (!config_.odometry_from_tf) return;
  for (const messages::TransformStamped& transform : in.message.transforms) {
    if (input::frame_name(transform.header.frame_id) == config_.odom_frame &&
        input::frame_name(transform.child_frame_id) == config_.base_frame) {
      take_odometry(messages::seconds(transform.header.stamp), transform.transform.translation,
                    transform.transform.rotation);
    }
  }
}

void Node::take_odometry(double stamp_s, const messages::Vector3& position,
                         const messages::Quaternion& rotation) {
  const std::optional<Pose> pose = pose_from(position, rotation);
  if (!pose) throw core::InputError("odometry: is not finite or no rotation");
  if (setup_ && setup_->base_frame != config_.base_frame) {
    throw core::InputError(
        fmt::format("odometry of '{}', which /tf_static did not connect with "
                    "the camera",
                    config_.base_frame));
  }
  odometry_.add(stamp_s, *pose);
  publish_corrected_odometry();
}

void Node::take_one(const CommandIn& in) {
  const Answer answer = execute(in.command);
  if (!answer.is_done) refused(answer.text);
  if (in.answer) in.answer->send_newest(answer);
  const double stamp_s = newest_ ? newest_->stamp_s : 0.0;
  publisher_.diagnostics({.header = header_of("", stamp_s),
                          .status = {{.level = answer.is_done ? messages::DiagnosticStatus::kOk
                                                              : messages::DiagnosticStatus::kError,
                                      .name = "samewhere: command",
                                      .message = answer.text}}});
}

void Node::take_one(const Tick& /*tick*/) { publish_state(); }

void Node::use(FrameSet frame) {
  if (slam_) return track(frame);
  counts_.num_dropped += startup_->add(std::move(frame));
  if (why_not_started_.empty()) try_to_start();
}

void Node::try_to_start() {
  try {
    const auto setup = startup_->setup(static_transforms_);
    if (!setup) return set_status(setup.error());
    slam_ = library::watched_slam(setup->calibration, options_, watcher_);
    setup_ = *setup;
    prepare_grid();
  } catch (const std::exception& error) {
    why_not_started_ = core::printable_line(error.what(), core::kMaxMessage);
    refused(why_not_started_);
    return set_status("cannot start");
  }
  if (is_paused_) slam_->pause_mapping();
  frames_.begin_session();
  std::deque<FrameSet> frames = startup_->take_frames();
  startup_.reset();
  for (const FrameSet& waiting : frames) track(waiting);
}

void Node::prepare_grid() {
  if (config_.cameras != Cameras::kDepth || config_.grid_period_s == 0.0) return;
  const pipeline::Config config =
      library::config_of(options_.profile, options_.settings, options_.prior);
  grid_.emplace(
      GridOutput::Settings{
          .dense = config.dense, .period_s = config_.grid_period_s, .has_thread = options_.threads},
      setup_->first_camera, publisher_);
}

void Node::track(const FrameSet& frame) {
  std::vector<cv::Mat> images = {image_from(frame.first, "image")};
  Frame given{.stamp_s = frame.first.stamp_s, .images = {view_of(images[0])}, .depth = {}};
  if (config_.cameras == Cameras::kStereo) {
    images.push_back(image_from(*frame.second, "right/image"));
    given.images.push_back(view_of(images[1]));
  } else if (config_.cameras == Cameras::kDepth) {
    images.push_back(depth_from(*frame.second, config_.depth_units_per_m));
    given.depth = view_of(images[1]);
  }
  newest_ = slam_->track(given);
  if (grid_) grid_->take_frame(given.stamp_s, images[1]);
  ++counts_.num_frames;
  frames_.update(*newest_, setup_->camera_from_base);
  publish_frames(*newest_);
  publish_events();
  set_status(status_name(newest_->status));
  publish_map_if_due(*newest_);
}

Answer Node::execute(const Command& command) {
  try {
    return {.is_done = true, .text = carry_out(command)};
  } catch (const std::exception& error) {
    return {.is_done = false, .text = core::printable_line(error.what(), core::kMaxMessage)};
  }
}

std::string Node::carry_out(const Command& command) {
  switch (command.kind) {
    case CommandKind::kSaveMap:
      if (!slam_) throw core::InputError("save_map: there is no map yet (" + status_ + ")");
      slam_->save(command.file);
      return "saved " + command.file.string();
    case CommandKind::kLoadMap:
      return begin_in(command.file, MapUse::kExtend);
    case CommandKind::kLocalize:
      return begin_in(command.file, MapUse::kLocalize);
    case CommandKind::kReset:
      return begin_in({}, MapUse::kExtend);
    case CommandKind::kPause:
    case CommandKind::kResume:
      break;
  }
  const bool is_pause = command.kind == CommandKind::kPause;
  if (slam_ && is_pause) slam_->pause_mapping();
  if (slam_ && !is_pause) slam_->resume_mapping();
  is_paused_ = is_pause;
  return is_pause ? "mapping is paused" : "mapping goes on";
}

std::string Node::begin_in(const std::filesystem::path& map, MapUse use) {
  if (!slam_) {
    options_.map = map;
    options_.map_use = use;
    why_not_started_.clear();
  } else if (map.empty()) {
    slam_->reset();
  } else {
    slam_->load(map, use);
  }
  frames_.begin_session();
  is_paused_ = false;
  newest_.reset();
  waiting_for_odometry_.reset();
  map_told_s_.reset();
  map_version_told_ = 0;
  if (grid_) grid_->clear();
  return map.empty() ? "a new session with an empty map"
                     : "a new session in " + map.string() +
                           (use == MapUse::kLocalize ? ", which stays as it is" : "");
}

std::vector<StampedPose> Node::finish() {
  if (!slam_ || slam_->is_finished()) return {};
  std::vector<StampedPose> trajectory;
  try {
    slam_->finish();
    publish_events();
    trajectory = slam_->trajectory();
    map_told_s_.reset();
    if (grid_) grid_->hurry();
    if (newest_) publish_map_if_due(*newest_);
    grid_.reset();  // the last grid is made
  } catch (const std::exception& error) {
    refused(error.what());
  }
  return trajectory;
}

}  // namespace samewhere::node
