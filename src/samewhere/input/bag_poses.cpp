#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/bag_picture.hpp>
#include <samewhere/input/bag_poses.hpp>
#include <samewhere/input/bag_topics.hpp>

namespace samewhere::input {
namespace {

using bags::Topic;
using core::InputError;

bool is_transform_topic(const Topic& topic) {
  return topic.type == "tf2_msgs/TFMessage" || topic.type == "tf/tfMessage";
}

// A pose of a message, and of which frame.
struct FramePose {
  messages::Time stamp;
  std::string frame;                             // empty: the message does not say
  std::optional<core::Rigid3> world_from_frame;  // nothing: the numbers are no pose
};

std::optional<core::Rigid3> rigid_pose(const messages::Pose& pose) {
  return rigid_from(pose.position, pose.orientation);
}

FramePose pose_of(const messages::TransformStamped& message) {
  return {message.header.stamp, message.child_frame_id,
          rigid_from(message.transform.translation, message.transform.rotation)};
}
FramePose pose_of(const messages::Odometry& message) {
  return {message.header.stamp, message.child_frame_id, rigid_pose(message.pose.pose)};
}
FramePose pose_of(const messages::PoseWithCovarianceStamped& message) {
  return {message.header.stamp, "", rigid_pose(message.pose.pose)};
}
FramePose pose_of(const messages::PoseStamped& message) {
  return {message.header.stamp, "", rigid_pose(message.pose)};
}

FramePose read_pose(const Topic& topic, std::string_view bytes) {
  const messages::Layout layout = *bags::layout_of(topic);
  if (topic.type == "geometry_msgs/TransformStamped")
    return pose_of(messages::read_message<messages::TransformStamped>(bytes, layout));
  if (topic.type == "nav_msgs/Odometry")
    return pose_of(messages::read_message<messages::Odometry>(bytes, layout));
  if (topic.type == "geometry_msgs/PoseWithCovarianceStamped")
    return pose_of(messages::read_message<messages::PoseWithCovarianceStamped>(bytes, layout));
  return pose_of(messages::read_message<messages::PoseStamped>(bytes, layout));
}

// The frame of the only topic of pictures, or of the first that is no depth; empty: there is none.
std::string frame_of_pictures(const std::filesystem::path& path, bags::BagReader& bag) {
  std::vector<int> pictures;
  for (std::size_t i = 0; i < bag.topics().size(); ++i) {
    const Topic& topic = bag.topics()[i];
    const bool is_depth = topic.name.find("depth") != std::string::npos;
    if (is_image_topic(topic) && bags::layout_of(topic) && !is_depth)
      pictures.push_back(static_cast<int>(i));
  }
  bag.start(pictures);
  const auto message = bag.next();
  if (!message) return {};
  const Topic& topic = bag.topics()[static_cast<std::size_t>(message->topic)];
  return read_picture(path, topic, *message).frame_id;
}

// frame_from_camera; where nothing tells it the camera itself, with a warning.
core::Rigid3 camera_in(const Transforms& transforms, const std::string& frame,
                       const std::string& camera_frame, const std::string& topic) {
  if (const auto told = transforms.fixed(frame, camera_frame)) return *told;
  spdlog::warn(
      "{}: nothing tells where the frame '{}' is on the body of '{}'; its poses are taken "
      "for those of the camera",
      topic, frame, camera_frame);
  return {};
}

}  // namespace

Transforms read_transforms(bags::BagReader& bag, bool with_moving) {
  Transforms transforms;
  std::vector<int> topics;
  for (std::size_t i = 0; i < bag.topics().size(); ++i) {
    const Topic& topic = bag.topics()[i];
    const bool is_static = topic.name.ends_with("tf_static");
    if (is_transform_topic(topic) && bags::layout_of(topic) && topic.num_messages > 0 &&
        (is_static || with_moving))
      topics.push_back(static_cast<int>(i));
  }
  if (topics.empty()) return transforms;
  bag.start(topics);
  while (const auto message = bag.next()) {
    const Topic& topic = bag.topics()[static_cast<std::size_t>(message->topic)];
    const auto content =
        messages::read_message<messages::TFMessage>(message->bytes, *bags::layout_of(topic));
    for (const messages::TransformStamped& transform : content.transforms)
      transforms.add(transform, topic.name.ends_with("tf_static"));
  }
  return transforms;
}

core::Trajectory read_poses(bags::BagReader& bag, int position, const std::string& camera_frame) {
  const Topic& topic = bag.topics()[static_cast<std::size_t>(position)];
  if (is_transform_topic(topic)) return read_transforms(bag, true).trajectory_of(camera_frame);
  const Transforms transforms = read_transforms(bag, false);
  std::optional<core::Rigid3> frame_from_camera;
  core::Trajectory trajectory;
  bag.start({position});
  while (const auto message = bag.next()) {
    const FramePose pose = read_pose(topic, message->bytes);
    if (!frame_from_camera)
      frame_from_camera = camera_in(transforms, pose.frame, camera_frame, topic.name);
    const double stamp_s = messages::seconds(pose.stamp);
    const bool is_later = trajectory.empty() || stamp_s > trajectory.back().stamp_s;
    if (!is_later || !pose.world_from_frame) continue;
    trajectory.push_back({stamp_s, *pose.world_from_frame * *frame_from_camera});
  }
  return trajectory;
}

OdometryRows read_bag_odometry(const std::filesystem::path& path, const std::string& wanted) {
  const auto bag = bags::open_bag(path);
  const int topic = choose_odometry(path, bag->topics(), wanted);
  try {
    const std::string camera_frame = frame_of_pictures(path, *bag);
    OdometryRows rows;
    for (const core::StampedPose& pose : read_poses(*bag, topic, camera_frame))
      rows.push_back({pose.stamp_s, pose.world_from_camera, std::nullopt});
    if (!rows.empty()) return rows;
  } catch (const InputError& error) {
    const std::string reason = error.what();
    if (reason.starts_with(path.string())) throw;
    throw InputError(path.string() + ": " + reason);
  }
  throw InputError(fmt::format("{}: {} has no pose", path.string(),
                               bag->topics()[static_cast<std::size_t>(topic)].name));
}

}  // namespace samewhere::input
