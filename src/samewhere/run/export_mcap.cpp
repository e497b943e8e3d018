#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <samewhere/bags/bag.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/nanoseconds.hpp>
#include <samewhere/dense/grid_message.hpp>
#include <samewhere/dense/scans.hpp>
#include <samewhere/dense/stereo_depth.hpp>
#include <samewhere/dense/view.hpp>
#include <samewhere/input/message_image.hpp>
#include <samewhere/input/transforms.hpp>
#include <samewhere/pipeline/slam.hpp>
#include <samewhere/report/jpeg.hpp>
#include <samewhere/run/export_mcap.hpp>
#include <samewhere/run/export_model.hpp>
#include <samewhere/run/map_export.hpp>
#include <samewhere/run/source_frames.hpp>

namespace samewhere::run {
namespace {

constexpr const char* kMapFrame = "map";
constexpr const char* kBaseFrame = "base_link";
constexpr const char* kOpticalFrame = "camera_optical_frame";

// From the axes of an optical frame (x right, y down, z forward) to those of a body by REP-103.
core::Rigid3 base_from_optical() {
  Eigen::Matrix3d rotation;
  rotation << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return {.rotation = Eigen::Quaterniond(rotation)};
}

messages::Header stamped_header(std::int64_t time_ns, const char* frame) {
  return {.stamp = messages::time_of_nanoseconds(time_ns), .frame_id = frame};
}

messages::PointCloud2 cloud_of(const std::vector<report::ColouredPoint>& points,
                               const core::Rigid3& map_from_world) {
  constexpr std::uint32_t kStep = 16;
  messages::PointCloud2 cloud;
  cloud.width = static_cast<std::uint32_t>(points.size());
  cloud.point_step = kStep;
  cloud.row_step = kStep * cloud.width;
  cloud.data.resize(cloud.row_step);
  std::uint32_t offset = 0;
  for (const char* name : {"x", "y", "z", "rgb"}) {
    cloud.fields_of_point.push_back({.name = name, .offset = offset});
    offset += 4;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f in_map =
        (map_from_world * points[i].in_world.cast<double>()).cast<float>();
    const auto& [red, green, blue] = points[i].rgb;
    const std::uint32_t packed =
        (std::uint32_t{red} << 16) | (std::uint32_t{green} << 8) | std::uint32_t{blue};
    std::uint8_t* const place = cloud.data.data() + i * kStep;
    std::memcpy(place, in_map.data(), 12);
    std::memcpy(place + 12, &packed, 4);
  }
  return cloud;
}

// A row of the ledger, as report::ledger_row_json has it.
messages::DiagnosticStatus status_of(const nlohmann::json& row) {
  const std::string verdict = row.value("verdict", "");
  const std::string stage = row.value("stage", "");
  messages::DiagnosticStatus status;
  status.name = "samewhere: loop candidate";
  status.level = messages::DiagnosticStatus::kError;
  if (verdict == "LOOP") status.level = messages::DiagnosticStatus::kOk;
  if (verdict == "AMBIGUOUS" || stage == "withdrawn")
    status.level = messages::DiagnosticStatus::kWarn;
  status.message = verdict == "LOOP" ? "accepted" : stage + ": " + row.value("reason", "");
  status.values = {
      {"verdict", verdict}, {"query", row.at("query").dump()}, {"match", row.at("match").dump()}};
  if (row.contains("scores")) {
    for (const auto& [name, score] : row.at("scores").items())
      status.values.push_back({name, score.dump()});
  }
  return status;
}

// What the keyframes saw in depth.
class KeyframeScans {
 public:
  explicit KeyframeScans(const dense::Config& config)
      : config_(config), reader_(config), scans_(config) {}

  void add(const core::Frame& frame, const core::Rigid3& world_from_camera) {
    if (!frame.rig->is_calibrated() ||
        !std::holds_alternative<core::PinholeRadtan>(frame.rig->cameras[0]))
      return;
    const auto depth_m = dense::depth_of(frame, config_);
    if (!depth_m) return;
    scans_.add(
        reader_.points({frame.rig->cameras[0], world_from_camera, frame.images[0], *depth_m}),
        world_from_camera.translation);
    cameras_.push_back({0.0, world_from_camera});
  }

  // In a map whose x axis is that of the first keyframe's body.
  Result<dense::OccupancyGrid, std::string> grid(std::uint64_t seed) const {
    if (cameras_.empty()) return refuse(std::string("the recording has no depth"));
    return dense::find_grid(scans_.all(), cameras_,
                            core::inverse(base_from_optical()).rotation * Eigen::Vector3d::UnitX(),
                            config_, seed);
  }

 private:
  dense::Config config_;
  dense::PointReader reader_;
  dense::Scans scans_;
  core::Trajectory cameras_;
};

class McapOfRun {
 public:
  McapOfRun(const scene::StoredMap& stored, int session, const std::filesystem::path& file)
      : stored_(stored),
        session_(session),
        bag_(bags::make_bag(file, bags::BagFormat::kMcap, bags::Compression::kZstd)) {
    for (const core::FramePose& frame : stored.extras.frames)
      if (frame.frame.session() == session) frames_.push_back(frame);
    trajectory_ = pipeline::trajectory_of(stored.map, frames_);
    if (trajectory_.empty())
      throw core::InputError(file.string() + ": the map has no measured frame to export");
  }

  McapCounts write(const pipeline::Config& config) {
    declare();
    write_first();
    add_pictures(config);
    note_verdicts();
    for (const core::StampedPose& pose : trajectory_) {
      write_waiting(core::nanoseconds_of(pose.stamp_s));
      write_pose(pose);
    }
    write_waiting(INT64_MAX);
    bag_->finish();
    counts_.num_poses = trajectory_.size();
    return counts_;
  }

 private:
  core::Rigid3 map_from_base(const core::StampedPose& pose) const {
    return base_from_optical() * pose.world_from_camera * core::inverse(base_from_optical());
  }
  std::int64_t first_ns() const { return core::nanoseconds_of(trajectory_.front().stamp_s); }

  void declare() {
    tf_ = bag_->add_topic<messages::TFMessage>("/tf");
    tf_static_ = bag_->add_topic<messages::TFMessage>("/tf_static", true);
    pose_ = bag_->add_topic<messages::PoseStamped>("/pose");
    path_ = bag_->add_topic<messages::Path>("/path", true);
    points_ = bag_->add_topic<messages::PointCloud2>("/map_points", true);
    diagnostics_ = bag_->add_topic<messages::DiagnosticArray>("/diagnostics");
    picture_ = bag_->add_topic<messages::CompressedImage>("/camera/image/compressed");
    info_ = bag_->add_topic<messages::CameraInfo>("/camera/camera_info");
  }

  void write_first() {
    const messages::Header in_map = stamped_header(first_ns(), kMapFrame);
    bag_->write_message(tf_static_, first_ns(),
                        messages::TFMessage{{{stamped_header(first_ns(), kBaseFrame), kOpticalFrame,
                                              input::transform_of(base_from_optical())}}});
    messages::Path path{in_map, {}};
    for (const core::StampedPose& pose : trajectory_) path.poses.push_back(message_of(pose));
    bag_->write_message(path_, first_ns(), path);
    const auto points = points_of(stored_.map);
    messages::PointCloud2 cloud = cloud_of(points, base_from_optical());
    cloud.header = in_map;
    bag_->write_message(points_, first_ns(), cloud);
    counts_.num_points = points.size();
  }

  messages::PoseStamped message_of(const core::StampedPose& pose) const {
    const messages::Transform transform = input::transform_of(map_from_base(pose));
    return {stamped_header(core::nanoseconds_of(pose.stamp_s), kMapFrame),
            {transform.translation, transform.rotation}};
  }

  void write_pose(const core::StampedPose& pose) {
    const std::int64_t time_ns = core::nanoseconds_of(pose.stamp_s);
    bag_->write_message(tf_, time_ns,
                        messages::TFMessage{{{stamped_header(time_ns, kMapFrame), kBaseFrame,
                                              input::transform_of(map_from_base(pose))}}});
    bag_->write_message(pose_, time_ns, message_of(pose));
  }

  // What waits for its turn is held as bytes: pictures of keyframes as JPEG, verdicts.
  void wait_for_turn(int topic, std::int64_t time_ns, std::string bytes) {
    waiting_.emplace(time_ns, std::pair(topic, std::move(bytes)));
  }

  void write_waiting(std::int64_t until_ns) {
    while (!waiting_.empty() && waiting_.begin()->first <= until_ns) {
      const auto& [time_ns, message] = *waiting_.begin();
      bag_->write(message.first, time_ns, message.second);
      waiting_.erase(waiting_.begin());
    }
  }

  void add_pictures(const pipeline::Config& config) {
    std::map<std::uint64_t, const scene::Keyframe*> keyframes;
    std::set<std::uint64_t> positions;
    for (const scene::Keyframe* keyframe : keyframes_of_session(stored_.map, session_)) {
      keyframes[keyframe->view.frame.index()] = keyframe;
      positions.insert(keyframe->view.frame.index());
    }
    SourceFrames frames(config, positions);
    KeyframeScans scans(config.dense);
    while (const auto frame = frames.next()) {
      const scene::Keyframe& keyframe = *keyframes.at(frame->id.index());
      add_picture(*frame, keyframe);
      scans.add(*frame, keyframe.world_from_body * keyframe.view.rig->body_from_camera[0]);
    }
    add_grid(scans.grid(static_cast<std::uint64_t>(config.seed)));
  }

  void add_grid(const Result<dense::OccupancyGrid, std::string>& grid) {
    if (!grid) {
      counts_.grid = "none: " + grid.error();
      return;
    }
    messages::OccupancyGrid message = dense::grid_message(*grid, base_from_optical());
    message.header = stamped_header(first_ns(), kMapFrame);
    message.info.map_load_time = message.header.stamp;
    counts_.grid =
        fmt::format("{} x {} cells of {} m", message.info.width, message.info.height, grid->cell_m);
    wait_for_turn(bag_->add_topic<messages::OccupancyGrid>("/map", true), first_ns(),
                  write_message(message, bag_->layout()));
  }

  void add_picture(const core::Frame& frame, const scene::Keyframe& keyframe) {
    const std::int64_t time_ns = core::nanoseconds_of(keyframe.view.stamp_s);
    const messages::Header header = stamped_header(time_ns, kOpticalFrame);
    const cv::Mat& picture = frame.images.front();
    const std::string jpeg = report::jpeg_bytes(picture, picture.cols);
    wait_for_turn(
        picture_, time_ns,
        write_message(messages::CompressedImage{header, "jpeg", {jpeg.begin(), jpeg.end()}},
                      bag_->layout()));
    messages::CameraInfo info =
        input::camera_info_of(camera_of_pictures(keyframe.view, {picture.size(), false}));
    info.header = header;
    wait_for_turn(info_, time_ns, write_message(info, bag_->layout()));
    ++counts_.num_pictures;
  }

  // At the stamp of the query; of a query whose frame was not measured at that of the one before.
  void note_verdicts() {
    for (const std::string& line : stored_.extras.ledger) {
      const nlohmann::json row = nlohmann::json::parse(line, nullptr, false);
      if (row.is_discarded() || !row.contains("query")) continue;
      if (row.value("query_session", 0) != session_) continue;
      const std::int64_t time_ns = stamp_ns_of(row.at("query").get<std::uint64_t>());
      const messages::DiagnosticArray array{stamped_header(time_ns, ""), {status_of(row)}};
      wait_for_turn(diagnostics_, time_ns, write_message(array, bag_->layout()));
      ++counts_.num_verdicts;
    }
  }

  std::int64_t stamp_ns_of(std::uint64_t position) const {
    const auto frame = std::upper_bound(frames_.begin(), frames_.end(), position,
                                        [](std::uint64_t index, const core::FramePose& pose) {
                                          return index < pose.frame.index();
                                        });
    return frame == frames_.begin() ? first_ns() : core::nanoseconds_of(std::prev(frame)->stamp_s);
  }

  const scene::StoredMap& stored_;
  int session_;
  std::unique_ptr<bags::BagWriter> bag_;
  std::vector<core::FramePose> frames_;
  core::Trajectory trajectory_;
  std::multimap<std::int64_t, std::pair<int, std::string>> waiting_;
  McapCounts counts_;
  int tf_ = -1;
  int tf_static_ = -1;
  int pose_ = -1;
  int path_ = -1;
  int points_ = -1;
  int diagnostics_ = -1;
  int picture_ = -1;
  int info_ = -1;
};

}  // namespace

McapCounts write_mcap_of_run(const scene::StoredMap& stored, int session,
                             const pipeline::Config& config, const std::filesystem::path& file) {
  return McapOfRun(stored, session, file).write(config);
}

}  // namespace samewhere::run
