#pragma once

#include <filesystem>

#include <fmt/format.h>

#include <samewhere/bags/bag.hpp>
#include <samewhere/core/errors.hpp>

namespace samewhere::input {

// The content of a message of a recording. Throws InputError, which begins with the path and names
// topic and time.
template <class Payload>
Payload read_payload(const std::filesystem::path& file, const bags::Topic& topic,
                     const bags::Message& message) {
  try {
    return messages::read_message<Payload>(message.bytes, *bags::layout_of(topic));
  } catch (const core::InputError& error) {
    throw core::InputError(fmt::format("{}: {}: a message at {:.6f} s {}", file.string(),
                                       topic.name, static_cast<double>(message.log_time_ns) * 1e-9,
                                       error.what()));
  }
}

}  // namespace samewhere::input
