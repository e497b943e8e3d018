#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <samewhere/messages/messages.hpp>

namespace samewhere::messages {

// What a recording or a subscriber has to know of a type of message besides its bytes.
struct MessageType {
  std::string_view package;  // sensor_msgs
  std::string_view name;     // Image
  std::string_view fields;   // of the definition, a line each, in the syntax of ROS 2
  std::string_view md5;      // of the definition of ROS 1

  std::string ros2_name() const;  // sensor_msgs/msg/Image
  std::string ros1_name() const;  // sensor_msgs/Image
};

// One line of a definition.
struct FieldLine {
  std::string_view type;  // float64[9]
  std::string_view name;
};
std::vector<FieldLine> fields_of(const MessageType& type);

// All that this folder knows, those first of which others are made.
std::span<const MessageType> message_types();
// By a name of ROS 1 or ROS 2, or of DDS (sensor_msgs::msg::dds_::Image_); none: not known.
const MessageType* find_message_type(std::string_view name);

// The name of a type without what tells ROS 1, ROS 2 and DDS apart: sensor_msgs/Image.
std::string plain_type_name(std::string_view name);

// The definition with those of all types in it, as bags hold it: parted by a line of 80 '=' and
// `MSG: package/Name`, with the names and, in ROS 1, the Header of that layout.
std::string full_definition(const MessageType& type, Layout layout);

// The type of a struct of messages.hpp.
template <class Message>
const MessageType& type_of() {
  return *find_message_type(Message::kType);
}

}  // namespace samewhere::messages
