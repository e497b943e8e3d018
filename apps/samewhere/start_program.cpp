#include "start_program.hpp"

#include <cerrno>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>

namespace samewhere::app {

void start_program(const std::string& name, std::vector<std::string> arguments,
                   const std::string& command, const std::string& advice) {
  const std::filesystem::path here = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const std::string program = (here / name).string();
  arguments.insert(arguments.begin(), program);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  execv(program.c_str(), argv.data());
  const int error = errno;
  throw core::InputError(fmt::format("{}: {} cannot be started ({}); {}", command, program,
                                     std::generic_category().message(error), advice));
}

}  // namespace samewhere::app
