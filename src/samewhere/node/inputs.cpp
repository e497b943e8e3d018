#include <samewhere/node/inputs.hpp>

namespace samewhere::node {

Input<messages::CameraInfo> camera_info_input(const NodeTopic& topic, Stream stream) {
  return {topic, "", [stream](messages::CameraInfo message) {
            return CameraInfoIn{stream, std::move(message)};
          }};
}

Input<messages::TFMessage> transforms_input(const NodeTopic& topic, bool is_static) {
  return {topic, "", [is_static](messages::TFMessage message) {
            return TransformsIn{std::move(message), is_static};
          }};
}

Input<messages::Odometry> odometry_input() {
  return {kOdometryTopic, "",
          [](messages::Odometry message) { return OdometryIn{std::move(message)}; }};
}

Input<messages::String> command_input() {
  return {kCommandTopic, "", [](const messages::String& message) {
            return CommandIn{command_from(message.data), nullptr};
          }};
}

}  // namespace samewhere::node
