#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/interrupt.hpp>

namespace samewhere::core {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const char* what, int error) {
  throw InputError(path.string() + ": " + what + ": " + std::strerror(error));
}

// Closes what it holds.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&&) = delete;
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  int number() const { return number_; }
  bool is_open() const { return number_ >= 0; }

  // Returns the system's error number.
  int close() {
    const int result = ::close(number_);
    number_ = -1;
    return result == 0 ? 0 : errno;
  }

 private:
  int number_;
};

// ---- reading

bool is_readable_kind(const fs::path& path, unsigned mode) {
  return S_ISREG(mode) || (S_ISFIFO(mode) && is_open_descriptor(path));
}

// Looks before it opens, since opening a device may do something, and again at what was opened.
Descriptor open_to_read(const fs::path& path, struct stat& status) {
  if (path.native().find('\0') != std::string::npos)
    throw InputError(path.string() + ": cannot be read: its name has a zero byte");
  is_there(path);  // names a link that leads nowhere
  if (::stat(path.c_str(), &status) != 0) fail(path, "cannot be read", errno);
  if (!is_readable_kind(path, status.st_mode))
    throw InputError(path.string() + ": " + complaint_about_kind(status.st_mode));
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
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
  const Descriptor file = open_to_read(path, status);
  const auto told_size = static_cast<std::uint64_t>(std::max<off_t>(status.st_size, 0));
  if (told_size > limit.num_bytes) refuse_size(path, limit);
  return read_all(path, file.number(), told_size, limit);
}

std::string read_beginning(const fs::path& path, std::size_t num_bytes) {
  struct stat status {};
  is_there(path);  // names a link that leads nowhere
  if (::stat(path.c_str(), &status) != 0) fail(path, "cannot be read", errno);
  if (!S_ISREG(status.st_mode)) return {};
  const Descriptor file = open_to_read(path, status);
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

// ---- writing

namespace {

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

// A pipe or a terminal takes bytes, and cannot be put in another's place. What a link leads to
// belongs to another.
bool is_stream(const fs::path& path) {
  std::error_code error;
  const auto kind = fs::symlink_status(path, error).type();
  using enum fs::file_type;
  return kind == character || kind == fifo || kind == socket;
}

// Not opened anew: where the output is a file that would begin at its start.
int descriptor_of(const fs::path& path) {
  if (path == "/dev/stdout") return STDOUT_FILENO;
  if (path == "/dev/stderr") return STDERR_FILENO;
  if (path == "/dev/stdin") return STDIN_FILENO;
  return std::atoi(path.filename().c_str());
}

bool is_device(const fs::path& path) {
  std::error_code error;
  return fs::is_block_file(fs::symlink_status(path, error)) ||
         fs::is_character_file(fs::symlink_status(path, error));
}

void write_stream(const fs::path& path, std::string_view content) {
  const Descriptor stream(is_open_descriptor(path)
                              ? ::fcntl(descriptor_of(path), F_DUPFD_CLOEXEC, 0)
                              : ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK));
  if (!stream.is_open() && errno == ENXIO)
    throw InputError(path.string() + ": cannot be written: no program reads this pipe");
  if (!stream.is_open()) fail(path, "cannot be written", errno);
  if (!is_open_descriptor(path)) ::fcntl(stream.number(), F_SETFL, 0);
  const int error = write_bytes(stream.number(), content);
  if (error != 0) fail(path, "cannot be written", error);
}

constexpr std::string_view kPartial = ".partial-";

// Calls `make` with names beside `path` until one is made that was not there. Returns its result,
// negative with the reason in errno if none could be.
template <class Make>
int make_beside(const fs::path& path, fs::path& name, const Make& make) {
  constexpr int kMaxNames = 1000;
  int made = -1;
  for (int number = 0; number < kMaxNames; ++number) {
    name = path;
    name += fmt::format("{}{}-{}", kPartial, ::getpid(), number);
    made = make(name.c_str());
    if (made >= 0 || errno != EEXIST) break;
  }
  return made;
}

int make_file(const char* name) {
  return ::open(name, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0644);
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

// So that a name, too, survives the loss of power. Where the system cannot, it is as good as it
// gets.
void sync_folder(const fs::path& folder) {
  const Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (opened.is_open()) ::fsync(opened.number());
}

}  // namespace

void replace_file(const fs::path& path, std::string_view content) {
  if (is_device(path)) throw InputError(path.string() + ": is a device, expected a file");
  fs::path partial;
  Descriptor file(make_beside(path, partial, &make_file));
  if (!file.is_open()) fail(path, "cannot be written", errno);
  int error = write_all(file.number(), content);
  const int close_error = file.close();
  if (error == 0) error = close_error;
  if (error == 0 && ::rename(partial.c_str(), path.c_str()) != 0) error = errno;
  if (error == 0) return sync_folder(folder_of(path));
  ::unlink(partial.c_str());
  fail(path, "cannot be written", error);
}

void write_file(const fs::path& path, std::string_view content) {
  if (is_open_descriptor(path) || is_stream(path)) return write_stream(path, content);
  replace_file(path, content);
}

void remove_partial_files(const fs::path& path) {
  const std::string start = path.filename().string() + std::string(kPartial);
  std::error_code error;
  for (fs::directory_iterator entry(folder_of(path), error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const bool is_partial =
        name.starts_with(start) &&
        name.find_first_not_of("0123456789-", start.size()) == std::string::npos;
    std::error_code ignored;
    if (is_partial) fs::remove(entry->path(), ignored);
  }
}

void make_writable_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(folder.string() + ": cannot be made: " + error.message());
  fs::path probe;
  const Descriptor file(make_beside(folder / ".samewhere", probe, &make_file));
  if (!file.is_open()) fail(folder, "cannot be written", errno);
  ::unlink(probe.c_str());
}

bool make_new_folder(const fs::path& folder) {
  std::error_code error;
  if (folder.has_parent_path()) fs::create_directories(folder.parent_path(), error);
  if (error)
    throw InputError(folder.parent_path().string() + ": cannot be made: " + error.message());
  if (::mkdir(folder.c_str(), 0777) == 0) return true;
  if (errno != EEXIST) fail(folder, "cannot be made", errno);
  return false;
}

}  // namespace samewhere::core
