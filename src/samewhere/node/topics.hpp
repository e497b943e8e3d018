#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace samewhere::node {

// How a topic is delivered, in the words of ROS 2.
struct Quality {
  bool is_reliable = true;
  bool is_kept = false;  // transient local: a late subscriber gets the last one
  int depth = 5;         // keep last
};

// A name of a topic by which other programs remap it, relative to the namespace unless it begins
// with a slash.
struct NodeTopic {
  std::string_view name;
  Quality quality;
};

inline constexpr Quality kSensorData{.is_reliable = false, .is_kept = false, .depth = 5};

// Taken. With node.compressed the images are those of image_transport: NAME/compressed.
inline constexpr NodeTopic kImageTopic{"image", kSensorData};
inline constexpr NodeTopic kCameraInfoTopic{"camera_info", kSensorData};
inline constexpr NodeTopic kDepthTopic{"depth", kSensorData};
inline constexpr NodeTopic kRightImageTopic{"right/image", kSensorData};
inline constexpr NodeTopic kRightCameraInfoTopic{"right/camera_info", kSensorData};
inline constexpr NodeTopic kOdometryTopic{"odom", {.is_reliable = false, .depth = 100}};
inline constexpr NodeTopic kTransformsTopic{"/tf", {.depth = 100}};
inline constexpr NodeTopic kStaticTransformsTopic{"/tf_static", {.is_kept = true, .depth = 100}};
inline constexpr NodeTopic kCommandTopic{"samewhere/command", {.depth = 10}};

// Given, beside /tf.
inline constexpr NodeTopic kPoseTopic{"samewhere/pose", {.depth = 10}};
inline constexpr NodeTopic kPathTopic{"samewhere/path", {.is_kept = true, .depth = 1}};
inline constexpr NodeTopic kLandmarksTopic{"samewhere/landmarks", {.is_kept = true, .depth = 1}};
inline constexpr NodeTopic kGridTopic{"map", {.is_kept = true, .depth = 1}};
inline constexpr NodeTopic kStatusTopic{"samewhere/status", {.is_kept = true, .depth = 1}};
inline constexpr NodeTopic kDiagnosticsTopic{"/diagnostics", {.depth = 100}};

// Names of topics with the namespace and remappings of a node, `from:=to`.
class TopicNames {
 public:
  // Throws core::InputError on a remapping that is none.
  TopicNames(const std::string& node_namespace, const std::vector<std::string>& remappings);

  // "/robot/camera/image" for "image", remapped to camera/image, in the namespace robot. Of
  // NAME/compressed the remapping is that of NAME, if it has none itself.
  std::string name_of(std::string_view topic) const;

 private:
  struct Remapping {
    std::string from;
    std::string to;
  };
  std::string resolved(std::string_view name) const;

  std::string namespace_;
  std::vector<Remapping> remappings_;
};

}  // namespace samewhere::node
