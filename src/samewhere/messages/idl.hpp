#pragma once

#include <span>
#include <string>

#include <samewhere/messages/types.hpp>

namespace samewhere::messages {

// The types as OMG IDL, with the names that ROS 2 gives them in DDS: Image is
// sensor_msgs::msg::dds_::Image_ and its fields end in an underscore. `types`: those first of which
// others are made.
std::string idl_of(std::span<const MessageType> types);

}  // namespace samewhere::messages
