#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include <samewhere/node/config.hpp>
#include <samewhere/node/incoming.hpp>
#include <samewhere/node/topics.hpp>

namespace samewhere::node {

// A topic that a node takes, and what its messages are to the node.
template <class Message>
struct Input {
  NodeTopic topic;
  std::string_view subtopic;  // behind the topic's name, whose remapping it follows; or empty
  std::function<Incoming(Message)> incoming_from;  // throws core::InputError
};

template <class Image>
Input<Image> image_input(const NodeTopic& topic, std::string_view subtopic, Stream stream) {
  return {topic, subtopic, [stream](Image message) { return ImageIn{stream, std::move(message)}; }};
}
Input<messages::CameraInfo> camera_info_input(const NodeTopic& topic, Stream stream);
Input<messages::TFMessage> transforms_input(const NodeTopic& topic, bool is_static);
Input<messages::Odometry> odometry_input();
Input<messages::String> command_input();

// Calls `subscribe(const Input<Message>&)` for each topic that a node with that configuration
// takes.
template <class Subscribe>
void subscribe_to_inputs(const Config& config, const Subscribe& subscribe) {
  const auto to_images = [&](NodeTopic topic, Stream stream, bool is_compressed) {
    topic.quality.is_reliable = config.is_reliable;
    if (is_compressed) {
      subscribe(image_input<messages::CompressedImage>(topic, "/compressed", stream));
    } else {
      subscribe(image_input<messages::Image>(topic, "", stream));
    }
  };
  to_images(kImageTopic, Stream::kFirst, config.is_compressed);
  subscribe(camera_info_input(kCameraInfoTopic, Stream::kFirst));
  if (config.cameras == Cameras::kDepth) to_images(kDepthTopic, Stream::kSecond, false);
  if (config.cameras == Cameras::kStereo) {
    to_images(kRightImageTopic, Stream::kSecond, config.is_compressed);
    subscribe(camera_info_input(kRightCameraInfoTopic, Stream::kSecond));
  }
  subscribe(odometry_input());
  subscribe(transforms_input(kStaticTransformsTopic, true));
  if (config.odometry_from_tf) subscribe(transforms_input(kTransformsTopic, false));
  subscribe(command_input());
}

}  // namespace samewhere::node
