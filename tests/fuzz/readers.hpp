#pragma once

#include <string>
#include <string_view>

#include <samewhere/messages/wire.hpp>

namespace samewhere::test {

// Both read the bytes of a fuzzer as the program reads those of a recording. Bytes that are refused
// with an InputError are fine. What the readers promise is checked: a ContractError is a finding,
// as every other exception is.

// The bytes are a file: .mcap, .db3 or .bag, told by its beginning. All its messages are read, and
// those of known types decoded.
void read_as_bag(std::string_view bytes);

// The first byte chooses a type and a layout (message_input); the others are the message. Images
// are decoded, as pictures and as depth, and calibrations become cameras.
void read_as_message(std::string_view bytes);

// What read_as_message reads as a message of that type ("sensor_msgs/Image").
std::string message_input(std::string_view type, messages::Layout layout, std::string_view bytes);

}  // namespace samewhere::test
