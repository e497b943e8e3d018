#pragma once

// Runs the built program as a user does.

#include <cstdlib>
#include <filesystem>
#include <string>

#include <sys/wait.h>

#include <samewhere/core/file.hpp>

namespace samewhere::test {

struct Outcome {
  int exit_code = -1;  // 128 + signal if it was killed
  std::string out;
  std::string err;
};

// `arguments` is a piece of shell. What it prints is caught in `scratch`.
inline Outcome run_program(const std::string& arguments, const std::filesystem::path& scratch) {
  const std::filesystem::path out = scratch / "stdout.txt";
  const std::filesystem::path err = scratch / "stderr.txt";
  const std::string command = std::string("'") + SAMEWHERE_PROGRAM + "' " + arguments + " >'" +
                              out.string() + "' 2>'" + err.string() + "' </dev/null";
  const int status = std::system(command.c_str());
  const int exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return {exit_code, core::read_file(out), core::read_file(err)};
}

inline std::string quoted(const std::filesystem::path& path) { return "'" + path.string() + "'"; }

}  // namespace samewhere::test
