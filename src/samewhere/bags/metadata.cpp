#include <fmt/format.h>

#include <samewhere/bags/bag.hpp>

namespace samewhere::bags {

std::string rosbag2_metadata(const BagReader& bag, const std::string& file_name) {
  const BagInfo& info = bag.info();
  const bool is_mcap_file = info.format == "MCAP";
  std::string text = fmt::format(
      "rosbag2_bagfile_information:\n"
      "  version: 5\n"
      "  storage_identifier: {}\n"
      "  duration:\n    nanoseconds: {}\n"
      "  starting_time:\n    nanoseconds_since_epoch: {}\n"
      "  message_count: {}\n"
      "  compression_format: \"\"\n  compression_mode: \"\"\n"
      "  relative_file_paths:\n    - {}\n"
      "  topics_with_message_count:\n",
      is_mcap_file ? "mcap" : "sqlite3", info.last_ns - info.first_ns, info.first_ns,
      info.num_messages, file_name);
  for (const Topic& topic : bag.topics()) {
    const messages::MessageType* const type = messages::find_message_type(topic.type);
    text += fmt::format(
        "    - topic_metadata:\n"
        "        name: {}\n        type: {}\n        serialization_format: {}\n"
        "        offered_qos_profiles: \"\"\n"
        "      message_count: {}\n",
        topic.name, type == nullptr ? topic.type : type->ros2_name(), topic.encoding,
        topic.num_messages);
  }
  return text;
}

}  // namespace samewhere::bags
