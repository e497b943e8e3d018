#include <array>
#include <string_view>
#include <utility>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/printable.hpp>
#include <samewhere/node/incoming.hpp>

namespace samewhere::node {
namespace {

struct CommandName {
  std::string_view name;
  CommandKind kind;
  bool has_file;
};

constexpr std::array kCommands = {CommandName{"save_map", CommandKind::kSaveMap, true},
                                  CommandName{"load_map", CommandKind::kLoadMap, true},
                                  CommandName{"localize", CommandKind::kLocalize, true},
                                  CommandName{"reset", CommandKind::kReset, false},
                                  CommandName{"pause", CommandKind::kPause, false},
                                  CommandName{"resume", CommandKind::kResume, false}};

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r\n") - begin + 1);
}

}  // namespace

Command command_from(const std::string& text) {
  const std::string_view all = trimmed(text);
  const std::string_view name = all.substr(0, all.find_first_of(" \t"));
  const std::string_view file = trimmed(all.substr(name.size()));
  for (const CommandName& command : kCommands) {
    if (command.name == name && command.has_file == !file.empty()) return {command.kind, file};
  }
  throw core::InputError("command '" + core::printable_line(text, core::kMaxMessage) +
                         "': expected save_map FILE, load_map FILE, localize FILE, reset, pause or "
                         "resume");
}

}  // namespace samewhere::node
