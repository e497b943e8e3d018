#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/open_file.hpp>

namespace samewhere::core {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const char* what, int error) {
  throw InputError(path.string() + ": " + what + ": " + std::strerror(error));
}

// ---- reading

bool is_readable_kind(const fs::path& path, unsigned mode) {
  return S_ISREG(mode) || (S_ISFIFO(mode) && is_open_descriptor(path));
}

// Looks before it opens, since opening a device may do something, and again at what was opened.
OpenFile open_to_read(const fs::path& path, struct stat& status) {
  if (path.native().find('\0') != std::string::npos)
    throw InputError(path.string() + ": cannot be read: its name has a zero byte");
  is_there(path);  // names a link that leads nowhere
  if (::stat(path.c_str(), &status) != 0) fail(path, "cannot be read", errno);
  if (!is_readable_kind(path, status.st_mode))
    throw InputError(path.string() + ": " + complaint_about_kind(status.st_mode));
  OpenFile file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  if (!file.is_open()) fail(path, "cannot be read", errno);
  if (::fstat(file.number(), &status) != 0) fail(path, "cannot be read", errno);
  if (!is_readable_kind(path, status.st_mode))
    throw InputError(path.string() + ": " + complaint_about_kind(status.st_mode));
  ::fcntl(file.number(), F_SETFL, 0);  // a pipe that was given open is waited for
  return file;
}

[[noreturn]] void refuse_size(const fs::path& path, const SizeLimit& limit) {
  throw InputError(fmt::format("{}: is larger than {} MB, expected {} of at most that size",
                               path.string(), limit.num_bytes / kMegabyte, limit.kind));
}

// Up to the end of the file, whatever size the system tells before.
std::string read_all(const fs::path& path, int file, std::uint64_t told_size,
                     const SizeLimit& limit) {
  constexpr std::size_t kStep = 1 << 16;
  constexpr std::size_t kLong = 1 << 24;  // Ctrl-C is looked for in files that take a while
  std::string content(static_cast<std::size_t>(told_size) + kStep, '\0');
  std::size_t filled = 0;
  while (true) {
    const std::size_t wanted = std::min(content.size() - filled, kLong);
    const ssize_t got = ::read(file, content.data() + filled, wanted);
    if (got < 0 && errno == EINTR) {
      stop_if_interrupted();
      continue;
    }
    if (got < 0) fail(path, "cannot be read", errno);
    if (got == 0) break;
    filled += static_cast<std::size_t>(got);
    if (filled > limit.num_bytes) refuse_size(path, limit);
    if (filled >= kLong) stop_if_interrupted();
    if (filled == content.size()) content.resize(2 * filled);
  }
  content.resize(filled);
  return content;
}

}  // namespace

std::string read_file(const fs::path& path, const SizeLimit& limit) {
  struct stat status {};
  const OpenFile file = open_to_read(path, status);
  const auto told_size = static_cast<std::uint64_t>(std::max<off_t>(status.st_size, 0));
  if (told_size > limit.num_bytes) refuse_size(path, limit);
  return read_all(path, file.number(), told_size, limit);
}

std::string read_beginning(const fs::path& path, std::size_t num_bytes) {
  struct stat status {};
  is_there(path);  // names a link that leads nowhere
  if (::stat(path.c_str(), &status) != 0) fail(path, "cannot be read", errno);
  if (!S_ISREG(status.st_mode)) return {};
  const OpenFile file = open_to_read(path, status);
  std::string content(num_bytes, '\0');
  std::size_t filled = 0;
  while (filled < num_bytes) {
    const ssize_t got = ::read(file.number(), content.data() + filled, num_bytes - filled);
    if (got < 0 && errno != EINTR) fail(path, "cannot be read", errno);
    if (got == 0) break;
    if (got > 0) filled += static_cast<std::size_t>(got);
  }
  content.resize(filled);
  return content;
}

}  // namespace samewhere::core
