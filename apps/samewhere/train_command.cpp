#include <cerrno>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "commands.hpp"
#include <samewhere/core/errors.hpp>

namespace samewhere::app {
namespace {

// Becomes the training program, which lies beside this one where it was built: it needs libtorch,
// and whoever does not train needs not have that.
[[noreturn]] void start_training(std::vector<std::string> arguments) {
  const std::filesystem::path here = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const std::string program = (here / "samewhere-train").string();
  arguments.insert(arguments.begin(), program);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  execv(program.c_str(), argv.data());
  const int error = errno;
  throw core::InputError(
      fmt::format("train: {} cannot be started ({}); `./run train` installs libtorch and builds it",
                  program, std::generic_category().message(error)));
}

}  // namespace

void add_train_command(CLI::App& app) {
  CLI::App* sub = app.add_subcommand(
      "train", "Train the network that describes a view (samewhere train --help)");
  // all that follows is for the training program, --help too
  sub->set_help_flag();
  sub->prefix_command();
  sub->callback([sub] { start_training(sub->remaining()); });
}

}  // namespace samewhere::app
