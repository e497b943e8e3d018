#include <cerrno>
#include <cstdio>
#include <cstdlib>

#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <samewhere/core/printable.hpp>
#include <samewhere/core/terminal.hpp>

namespace samewhere::core {
namespace {

int first_error = 0;  // of standard output; the main thread alone prints

bool is_coloured() {
  const char* const no_color = std::getenv("NO_COLOR");  // no-color.org
  const char* const kind = std::getenv("TERM");
  const bool is_plain = kind == nullptr || std::string_view(kind) == "dumb";
  return ::isatty(STDERR_FILENO) == 1 && (no_color == nullptr || *no_color == 0) && !is_plain;
}

std::string_view colour_of(Severity severity) {
  switch (severity) {
    case Severity::kWarning:
      return "\x1b[33m";
    case Severity::kError:
      return "\x1b[31m";
    case Severity::kInfo:
      break;
  }
  return "";
}

}  // namespace

void print_text(std::string_view text) {
  const std::string clean = printable_text(text);
  errno = 0;
  const bool is_written = std::fwrite(clean.data(), 1, clean.size(), stdout) == clean.size();
  if (!is_written && first_error == 0) first_error = errno != 0 ? errno : EIO;
}

std::size_t stderr_width() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

std::string line_for_stderr(std::string_view line, Severity severity) {
  const std::string_view start = ::isatty(STDERR_FILENO) == 1 ? "\r\x1b[2K" : "";
  const std::string_view colour = is_coloured() ? colour_of(severity) : "";
  return fmt::format("{}{}{}{}", start, colour, line, colour.empty() ? "" : "\x1b[0m");
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
