#include <algorithm>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include <samewhere/node/outputs.hpp>
#include <samewhere/node/transforms.hpp>

namespace samewhere::node {
namespace {

using messages::DiagnosticStatus;
using messages::KeyValue;

std::string frame_text(const FrameKey& frame) {
  return frame.session == 0 ? fmt::format("{}", frame.index)
                            : fmt::format("{} of session {}", frame.index, frame.session);
}

std::string decision_text(const LoopVerdict& verdict) {
  switch (verdict.decision) {
    case LoopDecision::kAccepted:
      return "accepted";
    case LoopDecision::kRejected:
      return "rejected";
    case LoopDecision::kAmbiguous:
      return "ambiguous";
    case LoopDecision::kWithdrawn:
      return "withdrawn";
  }
  return "";
}

template <class Number>
void add_value(std::vector<KeyValue>& values, const char* key,
               const std::optional<Number>& number) {
  if (number) values.push_back({key, fmt::format("{:.6g}", static_cast<double>(*number))});
}

DiagnosticStatus status_of_event(const LoopVerdict& verdict) {
  const std::string decision = decision_text(verdict);
  const bool is_open =
      verdict.decision == LoopDecision::kAmbiguous || verdict.decision == LoopDecision::kWithdrawn;
  DiagnosticStatus status{
      .level = is_open ? DiagnosticStatus::kWarn : DiagnosticStatus::kOk,
      .name = verdict.is_relocalization ? "samewhere: relocalization candidate"
                                        : "samewhere: loop candidate",
      .message = verdict.reason.empty() ? decision : decision + ": " + verdict.reason,
      .values = {{"candidate", fmt::format("{}", verdict.candidate)},
                 {"decision", decision},
                 {"check", verdict.check},
                 {"query", frame_text(verdict.query)},
                 {"match", frame_text(verdict.match)}}};
  const LoopScores& scores = verdict.scores;
  add_value(status.values, "similarity", std::optional(scores.similarity));
  add_value(status.values, "inliers", scores.num_inliers);
  add_value(status.values, "inlier_ratio", scores.inlier_ratio);
  add_value(status.values, "correction_m", scores.correction_m);
  add_value(status.values, "correction_rad", scores.correction_rad);
  add_value(status.values, "odometry_chi_square", scores.odometry_chi_square);
  return status;
}

DiagnosticStatus status_of_event(const TrackingLost& lost) {
  return {.level = DiagnosticStatus::kWarn,
          .name = "samewhere: tracking",
          .message = "lost",
          .values = {{"last_pose_stamp_s", fmt::format("{:.6f}", lost.last_pose_stamp_s)}}};
}

DiagnosticStatus status_of_event(const Relocalized& relocalized) {
  switch (relocalized.step) {
    case RelocalizationStep::kConfirmed:
      return {.name = "samewhere: tracking", .message = "relocalized"};
    case RelocalizationStep::kTakenBack:
      return {.level = DiagnosticStatus::kWarn,
              .name = "samewhere: tracking",
              .message = "the provisional pose was wrong; lost"};
    case RelocalizationStep::kProvisional:
      break;
  }
  return {.level = DiagnosticStatus::kWarn,
          .name = "samewhere: tracking",
          .message = "relocalized, not confirmed"};
}

DiagnosticStatus status_of_event(const MapCorrected& corrected) {
  double largest_m = 0.0;
  for (const MapCorrected::Move& move : corrected.moves) {
    const Eigen::Vector3d step =
        move.new_map_from_camera.translation() - move.old_map_from_camera.translation();
    largest_m = std::max(largest_m, step.norm());
  }
  return {.name = "samewhere: map",
          .message = fmt::format("corrected: {} keyframes, by {:.3f} m at most",
                                 corrected.moves.size(), largest_m)};
}

DiagnosticStatus status_of_event(const MapDiscarded& /*discarded*/) {
  return {.level = DiagnosticStatus::kWarn,
          .name = "samewhere: map",
          .message = "re-initialization: the map was replaced by a new one"};
}

DiagnosticStatus status_of_event(const KeyframeInserted& /*inserted*/) { return {}; }

// Of the points of a cloud, as bytes.
struct CloudPoint {
  float x = 0.0F, y = 0.0F, z = 0.0F;
  std::uint32_t rgb = 0;
};

void append(std::vector<std::uint8_t>& data, const Map::Landmark& landmark) {
  const Eigen::Vector3f p = landmark.in_map.cast<float>();
  const auto& [red, green, blue] = landmark.rgb;
  const CloudPoint point{
      p.x(), p.y(), p.z(),
      static_cast<std::uint32_t>(red) << 16U | static_cast<std::uint32_t>(green) << 8U | blue};
  const std::size_t begin = data.size();
  data.resize(begin + sizeof(point));
  std::memcpy(data.data() + begin, &point, sizeof(point));
}

}  // namespace

messages::Header header_of(const std::string& frame, double stamp_s) {
  return {.stamp = messages::time_of(stamp_s), .frame_id = frame};
}

messages::PoseWithCovarianceStamped pose_message(const messages::Header& header,
                                                 const Pose& map_from_base,
                                                 const Eigen::Matrix3d& map_from_body,
                                                 const std::optional<Covariance>& covariance) {
  messages::PoseWithCovarianceStamped message{.header = header};
  message.pose.pose = pose_message(map_from_base);
  if (!covariance) return message;
  Eigen::Matrix<double, 6, 6> turn = Eigen::Matrix<double, 6, 6>::Zero();
  turn.topLeftCorner<3, 3>() = map_from_body;
  turn.bottomRightCorner<3, 3>() = map_from_body;
  const Covariance in_map = turn * *covariance * turn.transpose();
  for (std::size_t i = 0; i < message.pose.covariance.size(); ++i)
    message.pose.covariance[i] = in_map(static_cast<int>(i) / 6, static_cast<int>(i) % 6);
  return message;
}

messages::Path path_message(const messages::Header& header, const Map& map,
                            const Pose& camera_from_base) {
  messages::Path path{.header = header};
  for (const Map::Keyframe& keyframe : map.keyframes()) {
    path.poses.push_back({{messages::time_of(keyframe.stamp_s), header.frame_id},
                          pose_message(keyframe.map_from_camera * camera_from_base)});
  }
  return path;
}

messages::PointCloud2 landmarks_message(const messages::Header& header, const Map& map,
                                        std::size_t most) {
  const std::vector<Map::Landmark> landmarks = map.landmarks();
  messages::PointCloud2 cloud{.header = header, .point_step = sizeof(CloudPoint)};
  for (const char* name : {"x", "y", "z", "rgb"}) {
    cloud.fields_of_point.push_back(
        {.name = name,
         .offset = static_cast<std::uint32_t>(sizeof(float) * cloud.fields_of_point.size())});
  }
  const std::size_t step = std::max<std::size_t>(1, (landmarks.size() + most - 1) / most);
  for (std::size_t i = 0; i < landmarks.size(); i += step) append(cloud.data, landmarks[i]);
  cloud.row_step = static_cast<std::uint32_t>(cloud.data.size());
  cloud.width = cloud.row_step / cloud.point_step;
  return cloud;
}

std::optional<messages::DiagnosticStatus> event_message(const Event& event) {
  if (std::holds_alternative<KeyframeInserted>(event.what)) return std::nullopt;
  DiagnosticStatus status =
      std::visit([](const auto& what) { return status_of_event(what); }, event.what);
  status.values.insert(status.values.begin(), {"frame", fmt::format("{}", event.frame)});
  return status;
}

std::string status_name(Status status) {
  switch (status) {
    case Status::kInitializing:
      return "initializing";
    case Status::kTracking:
      return "tracking";
    case Status::kWeak:
      return "weak";
    case Status::kLost:
      return "lost";
    case Status::kProvisional:
      return "provisional";
  }
  return "";
}

}  // namespace samewhere::node
