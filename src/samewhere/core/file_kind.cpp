#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <sys/stat.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file_kind.hpp>

namespace samewhere::core {
namespace {

namespace fs = std::filesystem;

bool is_link(const fs::path& path) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0 && S_ISLNK(status.st_mode);
}

// Throws if the path, or a folder on the way there, is a link that cannot be followed.
void refuse_broken_link(const fs::path& path, int error) {
  for (fs::path part = path; !part.empty(); part = part.parent_path()) {
    struct stat status {};
    if (::stat(part.c_str(), &status) == 0) return;
    if (is_link(part)) {
      std::error_code unread;
      const fs::path target = fs::read_symlink(part, unread);
      throw InputError(fmt::format(
          "{}: is a link to {}, {}", part.string(), target.string(),
          error == ENOENT ? "which is not there"
                          : "which cannot be followed: " + std::string(std::strerror(error))));
    }
    if (part == part.parent_path()) return;
  }
}

// Nothing where there is nothing.
std::optional<unsigned> mode_of(const fs::path& path) {
  if (path.native().find('\0') != std::string::npos) return std::nullopt;
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0) return status.st_mode;
  refuse_broken_link(path, errno);
  return std::nullopt;
}

}  // namespace

bool is_there(const fs::path& path) { return mode_of(path).has_value(); }

bool is_folder(const fs::path& path) {
  const auto mode = mode_of(path);
  return mode && S_ISDIR(*mode);
}

void require_file(const fs::path& path) {
  const auto mode = mode_of(path);
  if (!mode) throw InputError(path.string() + ": does not exist, expected a file");
  if (!S_ISREG(*mode)) throw InputError(path.string() + ": " + complaint_about_kind(*mode));
}

bool is_open_descriptor(const fs::path& path) {
  const std::string& name = path.native();
  if (name == "/dev/stdin" || name == "/dev/stdout" || name == "/dev/stderr") return true;
  for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"}) {
    if (name.size() <= folder.size() || !name.starts_with(folder)) continue;
    return std::all_of(name.begin() + static_cast<std::ptrdiff_t>(folder.size()), name.end(),
                       [](char c) { return c >= '0' && c <= '9'; });
  }
  return false;
}

std::string complaint_about_kind(unsigned mode) {
  const char* kind = "something else";
  if (S_ISDIR(mode)) kind = "a folder";
  if (S_ISFIFO(mode)) kind = "a pipe";
  if (S_ISCHR(mode) || S_ISBLK(mode)) kind = "a device";
  if (S_ISSOCK(mode)) kind = "a socket";
  return fmt::format("is {}, expected a file", kind);
}

}  // namespace samewhere::core
