#pragma once

#include <string>
#include <string_view>

#include <dds/dds.h>

struct ddsi_serdata;

namespace samewhere::dds_node {

// A topic without keys whose samples are bytes, the CDR of a message with its four bytes of
// encapsulation: Cyclone DDS carries them, samewhere::messages reads and writes them. dds_write()
// takes a std::string.
//
// Built on the interface that Cyclone DDS 0.10 has for other languages and for ROS 2
// (dds/ddsi/ddsi_sertype.h). Types are matched by their names, as those of ROS 2 are.
dds_entity_t create_raw_topic(dds_entity_t participant, const std::string& name,
                              const std::string& type_name);

// Of a sample that dds_takecdr() gave from such a topic; valid until it is released.
std::string_view bytes_of(const ddsi_serdata* sample);
void release(ddsi_serdata* sample);

}  // namespace samewhere::dds_node
