#pragma once

// Runs the built program as a user does.

#include <cstdlib>
#include <filesystem>
#include <string>

#include <fmt/format.h>
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
  const std::string command = fmt::format("'{}' {} >'{}' 2>'{}' </dev/null", SAMEWHERE_PROGRAM,
                                          arguments, out.string(), err.string());
  const int status = std::system(command.c_str());
  const int exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return {exit_code, core::read_file(out), core::read_file(err)};
}

inline std::string quoted(const std::filesystem::path& path) { return "'" + path.string() + "'"; }

// The same, with Ctrl-C pressed as soon as `is_time`, a piece of shell, succeeds.
inline Outcome interrupt_program(const std::string& arguments, const std::string& is_time,
                                 const std::filesystem::path& scratch) {
  const std::filesystem::path out = scratch / "stdout.txt";
  const std::filesystem::path err = scratch / "stderr.txt";
  // job control on: without it a shell's background process ignores SIGINT
  core::write_file(scratch / "interrupt.sh",
                   std::string("set -m\n'") + SAMEWHERE_PROGRAM + "' " + arguments + " >" +
                       quoted(out) + " 2>" + quoted(err) + " </dev/null &\nuntil " + is_time +
                       " >/dev/null 2>&1; do sleep 0.05; done\nkill -INT $!\nwait $!\n");
  const int status = std::system(("timeout 240 bash " + quoted(scratch / "interrupt.sh")).c_str());
  return {WEXITSTATUS(status), core::read_file(out), core::read_file(err)};
}

}  // namespace samewhere::test
