#include <cerrno>
#include <cstring>
#include <optional>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>

namespace samewhere::core {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const char* what, int error) {
  throw InputError(path.string() + ": " + what + ": " + std::strerror(error));
}

// Writes all of it, or returns the system's error number.
int write_bytes(int file, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(file, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

// The same, down to the disk.
int write_all(int file, std::string_view content) {
  const int error = write_bytes(file, content);
  if (error != 0) return error;
  return ::fsync(file) == 0 ? 0 : errno;
}

// Reads up to the end of the file, whatever size the system tells before, or returns nothing and
// leaves the reason in errno.
std::optional<std::string> read_all(int file) {
  constexpr std::size_t kStep = 1 << 16;
  struct stat status {};
  if (::fstat(file, &status) != 0) return std::nullopt;
  std::string content(static_cast<std::size_t>(status.st_size) + kStep, '\0');
  std::size_t filled = 0;
  while (true) {
    const ssize_t got = ::read(file, content.data() + filled, content.size() - filled);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return std::nullopt;
    if (got == 0) break;
    filled += static_cast<std::size_t>(got);
    if (filled == content.size()) content.resize(2 * filled);
  }
  content.resize(filled);
  return content;
}

}  // namespace

std::string read_file(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) fail(path, "cannot be read", errno);
  std::optional<std::string> content = read_all(file);
  const int error = errno;
  ::close(file);
  if (!content && error == EISDIR)
    throw InputError(path.string() + ": is a folder, expected a file");
  if (!content) fail(path, "cannot be read", error);
  return std::move(*content);
}

namespace {

constexpr std::string_view kStdout = "/dev/stdout";

// Where it leads to, if it is a link: to something, or to where something will be.
std::filesystem::path behind_links(std::filesystem::path path) {
  constexpr int kMaxLinks = 40;  // as many as the system follows
  std::error_code error;
  for (int i = 0; i < kMaxLinks && std::filesystem::is_symlink(path, error); ++i)
    path = path.parent_path() / std::filesystem::read_symlink(path, error);
  return path;
}

// A pipe or a terminal takes bytes, and cannot be put in another's place.
bool is_stream(const std::filesystem::path& path) {
  std::error_code error;
  const auto kind = std::filesystem::status(path, error).type();
  using enum std::filesystem::file_type;
  return kind == character || kind == fifo || kind == socket;
}

void write_stream(const std::filesystem::path& path, std::string_view content) {
  // not opened anew: where the output is a file that would begin at its start
  const int stream =
      path == kStdout ? ::dup(STDOUT_FILENO) : ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (stream < 0) fail(path, "cannot be written", errno);
  const int error = write_bytes(stream, content);
  ::close(stream);
  if (error != 0) fail(path, "cannot be written", error);
}

}  // namespace

void write_file(const std::filesystem::path& given, std::string_view content) {
  const std::filesystem::path path = given == kStdout ? given : behind_links(given);
  if (path == kStdout || is_stream(path)) return write_stream(path, content);
  std::filesystem::path partial = path;
  partial += ".partial";
  const int file = ::open(partial.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) fail(path, "cannot be written", errno);
  int error = write_all(file, content);
  if (::close(file) != 0 && error == 0) error = errno;
  if (error == 0 && ::rename(partial.c_str(), path.c_str()) != 0) error = errno;
  if (error == 0) return;
  ::unlink(partial.c_str());
  fail(path, "cannot be written", error);
}

void make_writable_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw InputError(folder.string() + ": cannot be made: " + error.message());
  const std::filesystem::path probe = folder / ".writable";
  try {
    write_file(probe, "");
  } catch (const InputError& why) {
    // of the probe nobody has heard
    throw InputError(folder.string() + std::string(why.what()).substr(probe.string().size()));
  }
  std::filesystem::remove(probe, error);
}

}  // namespace samewhere::core
