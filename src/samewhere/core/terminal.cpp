#include <cerrno>
#include <cstdio>

#include <fcntl.h>
#include <unistd.h>

#include <samewhere/core/printable.hpp>
#include <samewhere/core/terminal.hpp>

namespace samewhere::core {
namespace {

int first_error = 0;  // of standard output; the main thread alone prints

}  // namespace

void print_text(std::string_view text) {
  const std::string clean = printable_text(text);
  errno = 0;
  const bool is_written = std::fwrite(clean.data(), 1, clean.size(), stdout) == clean.size();
  if (!is_written && first_error == 0) first_error = errno != 0 ? errno : EIO;
}

void occupy_standard_streams() {
  for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(number, F_GETFD) >= 0 || errno != EBADF) continue;
    // opened for the other direction, so that using it fails; the lowest free number is this one
    static_cast<void>(::open("/dev/null", number == STDIN_FILENO ? O_WRONLY : O_RDONLY));
  }
}

int finish_standard_output() {
  errno = 0;
  const bool is_written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (!is_written && first_error == 0) first_error = errno != 0 ? errno : EIO;
  return first_error;
}

}  // namespace samewhere::core
