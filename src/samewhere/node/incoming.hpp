#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <variant>

#include <samewhere/core/channel.hpp>
#include <samewhere/messages/messages.hpp>

// What a node takes from a transport.

namespace samewhere::node {

// kFirst: camera 0. kSecond: its depth, or the right camera.
enum class Stream { kFirst, kSecond };

struct ImageIn {
  Stream stream = Stream::kFirst;
  std::variant<messages::Image, messages::CompressedImage> message;
};

struct CameraInfoIn {
  Stream stream = Stream::kFirst;
  messages::CameraInfo message;
};

struct OdometryIn {
  messages::Odometry message;
};

struct TransformsIn {
  messages::TFMessage message;
  bool is_static = false;  // of /tf_static
};

enum class CommandKind { kSaveMap, kLoadMap, kLocalize, kReset, kPause, kResume };

struct Command {
  CommandKind kind = CommandKind::kReset;
  std::filesystem::path file;  // of the first three
};

// "save_map FILE", "load_map FILE", "localize FILE", "reset", "pause", "resume". Throws
// core::InputError.
Command command_from(const std::string& text);

struct Answer {
  bool is_done = false;
  std::string text;  // one line: what was done, or why not
};

struct CommandIn {
  Command command;
  std::shared_ptr<core::Channel<Answer>> answer;  // none: the answer is a diagnostic alone
};

// Nothing came for a while: the state is told.
struct Tick {};

using Incoming = std::variant<ImageIn, CameraInfoIn, OdometryIn, TransformsIn, CommandIn, Tick>;

}  // namespace samewhere::node
