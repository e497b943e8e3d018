#include <algorithm>
#include <exception>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/csv.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/report/frames.hpp>

namespace samewhere::report {
namespace {

constexpr int kPoseFields = 7;
constexpr std::string_view kColumns =
    "index,stamp_s,name,status,is_measured,num_inliers,reference_keyframe,tx,ty,tz,qx,qy,qz,qw";

std::string pose_fields(const std::optional<core::Rigid3>& world_from_camera) {
  if (!world_from_camera) return ",,,,,,";
  const Eigen::Vector3d& t = world_from_camera->translation;
  const Eigen::Quaterniond& q = world_from_camera->rotation;
  return fmt::format("{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f}", t.x(), t.y(), t.z(), q.x(),
                     q.y(), q.z(), q.w());
}

// Columns are counted from the end, since the name may hold commas. Throws if there are too few.
std::string_view status_of(std::string_view record) {
  constexpr auto kBehind = std::ranges::count(kColumns.substr(kColumns.find("status")), ',');
  constexpr auto kFields = std::ranges::count(kColumns, ',') + 1;
  if (std::ranges::count(record, ',') + 1 < kFields) throw std::invalid_argument("short");
  for (int i = 0; i < kBehind; ++i) record = record.substr(0, record.rfind(','));
  return record.substr(record.rfind(',') + 1);
}

// Counted from 0 at the end: names may hold commas.
std::string_view field_from_end(std::string_view record, int field) {
  for (int i = 0; i < field; ++i) record = record.substr(0, record.rfind(','));
  return record.substr(record.rfind(',') + 1);
}

// All fields of a record but those of the pose.
std::string_view without_pose(std::string_view record) {
  for (int i = 0; i < kPoseFields; ++i) record = record.substr(0, record.rfind(','));
  return record;
}

}  // namespace

core::Trajectory measured_trajectory(const std::vector<FrameRecord>& frames) {
  core::Trajectory trajectory;
  for (const FrameRecord& frame : frames)
    if (frame.world_from_camera && is_confirmed(frame.pose))
      trajectory.push_back({frame.pose.stamp_s, *frame.world_from_camera});
  return trajectory;
}

std::string frames_csv(const std::vector<FrameRecord>& frames) {
  std::string text = fmt::format("{}\n", kColumns);
  for (const FrameRecord& frame : frames) {
    const core::FramePose& pose = frame.pose;
    const std::string keyframe = pose.reference_keyframe.is_valid()
                                     ? std::to_string(pose.reference_keyframe.index())
                                     : std::string();
    fmt::format_to(std::back_inserter(text), "{},{:.6f},{},{},{},{},{},{}\n", pose.frame.index(),
                   pose.stamp_s, core::csv_field(frame.name), core::name_of(pose.status),
                   frame.world_from_camera && is_confirmed(pose) ? 1 : 0, pose.num_inliers,
                   keyframe, pose_fields(frame.world_from_camera));
  }
  return text;
}

FrameTimes read_frames_csv(const std::filesystem::path& path) {
  const std::string text = core::read_file(path);
  FrameTimes frames;
  bool is_heading = true;
  for (const std::string_view record : core::csv_records(text)) {
    if (std::exchange(is_heading, false)) continue;
    const core::FrameId frame(frames.stamps_s.size());
    try {
      if (status_of(record) == core::name_of(core::FrameStatus::kResumed))
        frames.relocalized.insert(frame);
      frames.stamps_s.push_back(std::stod(std::string(record.substr(record.find(',') + 1))));
    } catch (const std::exception&) {
      throw core::InputError(fmt::format("{}, line {}: expected {}", path.string(),
                                         frames.stamps_s.size() + 2, kColumns));
    }
  }
  return frames;
}

std::string with_poses(const std::string& frames_csv, const core::Trajectory& trajectory) {
  const std::vector<std::string_view> records = core::csv_records(frames_csv);
  std::string text;
  std::size_t num_measured = 0;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const bool is_measured = i > 0 && field_from_end(without_pose(records[i]), 2) == "1";
    if (is_measured && num_measured < trajectory.size()) {
      const core::Rigid3& pose = trajectory[num_measured].world_from_camera;
      text += fmt::format("{},{}\n", without_pose(records[i]), pose_fields(pose));
    } else {
      text += records[i];
    }
    num_measured += is_measured ? 1 : 0;
  }
  if (num_measured != trajectory.size())
    throw core::InputError(fmt::format("{} measured poses; expected {}, as in the map",
                                       num_measured, trajectory.size()));
  return text;
}

}  // namespace samewhere::report
