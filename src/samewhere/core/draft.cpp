#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <samewhere/core/draft.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>

namespace samewhere::core {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, int error) {
  throw InputError(path.string() + ": cannot be written: " + std::strerror(error));
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

// Calls `make` with names beside `path` until one is made that was not there. Returns its result,
// negative with the reason in errno if none could be.
template <class Make>
int make_beside(const fs::path& path, fs::path& name, const Make& make) {
  constexpr int kMaxNames = 1000;
  int made = -1;
  for (int number = 0; number < kMaxNames; ++number) {
    name = path;
    name += fmt::format("{}{}-{}", kPartial, ::getpid(), number);
    made = make(name);
    if (made >= 0 || errno != EEXIST) break;
  }
  return made;
}

// By which a file without a name is given one.
std::string way_to(const OpenFile& file) { return fmt::format("/proc/self/fd/{}", file.number()); }

OpenFile make_nameless(const fs::path& folder) {
  OpenFile file(::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0644));
  if (file.is_open() && ::access(way_to(file).c_str(), F_OK) != 0) file.close();
  return file;
}

int make_named(const fs::path& name) {
  return ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0644);
}

// Without a name where that can be, else with the name that goes into `partial`. Not open, with the
// reason in errno, if none can be made.
OpenFile make(const fs::path& path, fs::path& partial) {
  OpenFile nameless = make_nameless(folder_of(path));
  if (nameless.is_open()) return nameless;
  return OpenFile(make_beside(path, partial, &make_named));
}

}  // namespace

void sync_folder_of(const fs::path& path) {
  const OpenFile folder(::open(folder_of(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder.is_open()) ::fsync(folder.number());
}

int error_of_new_file(const fs::path& folder) {
  fs::path partial;
  const OpenFile file = make(folder / ".samewhere", partial);
  if (!file.is_open()) return errno;
  if (!partial.empty()) ::unlink(partial.c_str());
  return 0;
}

Draft::Draft(const fs::path& path, std::string_view content)
    : path_(path), file_(make(path, partial_)) {
  if (!file_.is_open()) fail(path_, errno);
  int error = file_.write(content);
  if (error == 0 && ::fsync(file_.number()) != 0) error = errno;
  if (has_name()) {
    const int close_error = file_.close();
    if (error == 0) error = close_error;
    if (error != 0) ::unlink(partial_.c_str());
  }
  if (error != 0) fail(path_, error);
}

Draft::Draft(Draft&& other) noexcept
    : path_(std::move(other.path_)),
      partial_(std::exchange(other.partial_, fs::path())),
      file_(std::move(other.file_)) {}

Draft::~Draft() {
  if (has_name()) ::unlink(partial_.c_str());
}

// Returns 0, or -1 with the reason in errno.
int Draft::link_to(const fs::path& name) const {
  if (has_name()) return ::link(partial_.c_str(), name.c_str());
  return ::linkat(AT_FDCWD, way_to(file_).c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW);
}

void Draft::replace() {
  if (!has_name()) {
    fs::path name;
    if (make_beside(path_, name, [&](const fs::path& free) { return link_to(free); }) != 0)
      fail(path_, errno);
    partial_ = name;
  }
  if (::rename(partial_.c_str(), path_.c_str()) != 0) fail(path_, errno);
  partial_.clear();
}

bool Draft::publish_new() {
  if (link_to(path_) == 0) return true;
  if (errno == EEXIST) return false;
  const bool has_no_links = errno == EPERM || errno == EOPNOTSUPP || errno == ENOSYS;
  if (!has_no_links) fail(path_, errno);
  if (fs::exists(fs::symlink_status(path_))) return false;
  replace();
  return true;
}

}  // namespace samewhere::core
