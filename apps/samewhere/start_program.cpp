#include "start_program.hpp"

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/wait.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>

namespace samewhere::app {

namespace {

std::filesystem::path folder_of_this_program() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

std::vector<char*> argv_of(std::vector<std::string>& arguments) {
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  return argv;
}

// A build lies in build/NAME of the sources; an installed package is where Python looks.
void let_python_find_the_package() {
  const std::filesystem::path sources = folder_of_this_program() / ".." / ".." / "python";
  if (std::filesystem::is_directory(sources / "samewhere"))
    setenv("PYTHONPATH", sources.lexically_normal().c_str(), 1);
}

}  // namespace

void start_program(const std::string& name, std::vector<std::string> arguments,
                   const std::string& command, const std::string& advice) {
  const std::string program = (folder_of_this_program() / name).string();
  arguments.insert(arguments.begin(), program);
  execv(program.c_str(), argv_of(arguments).data());
  const int error = errno;
  throw core::InputError(fmt::format("{}: {} cannot be started ({}); {}", command, program,
                                     std::generic_category().message(error), advice));
}

std::optional<std::string> run_python(const std::string& module,
                                      const std::vector<std::string>& given) {
  std::vector<std::string> arguments{"python3", "-m", module};
  arguments.insert(arguments.end(), given.begin(), given.end());
  std::vector<char*> argv = argv_of(arguments);
  const pid_t child = fork();
  if (child < 0) return std::generic_category().message(errno);
  if (child == 0) {
    let_python_find_the_package();
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere >= 0) {
      dup2(nowhere, STDOUT_FILENO);
      dup2(nowhere, STDERR_FILENO);
    }
    execvp(argv[0], argv.data());
    _exit(127);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return std::nullopt;
  return fmt::format("python3 -m {} failed and tells why",
                     fmt::join(arguments.begin() + 2, arguments.end(), " "));
}

}  // namespace samewhere::app
