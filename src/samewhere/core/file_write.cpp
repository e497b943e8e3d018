#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>

namespace samewhere::core {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const char* what, int error) {
  throw InputError(path.string() + ": " + what + ": " + std::strerror(error));
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
  const OpenFile stream(is_open_descriptor(path)
                            ? ::fcntl(descriptor_of(path), F_DUPFD_CLOEXEC, 0)
                            : ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK));
  if (!stream.is_open() && errno == ENXIO)
    throw InputError(path.string() + ": cannot be written: no program reads this pipe");
  if (!stream.is_open()) fail(path, "cannot be written", errno);
  if (!is_open_descriptor(path)) ::fcntl(stream.number(), F_SETFL, 0);
  const int error = stream.write(content);
  if (error != 0) fail(path, "cannot be written", error);
}

}  // namespace

void replace_file(const fs::path& path, std::string_view content) {
  if (is_device(path)) throw InputError(path.string() + ": is a device, expected a file");
  Draft(path, content).replace();
  sync_folder_of(path);
}

void write_file(const fs::path& path, std::string_view content) {
  if (is_open_descriptor(path) || is_stream(path)) return write_stream(path, content);
  replace_file(path, content);
}

bool write_new_file(const fs::path& path, std::string_view content) {
  if (!Draft(path, content).publish_new()) return false;
  sync_folder_of(path);
  return true;
}

void FilesTogether::add(const fs::path& path, std::string_view content) {
  if (is_open_descriptor(path) || is_stream(path)) return write_stream(path, content);
  drafts_.emplace_back(path, content);
}

void FilesTogether::publish() {
  for (Draft& draft : drafts_) draft.replace();
  for (const Draft& draft : drafts_) sync_folder_of(draft.path());
  drafts_.clear();
}

void remove_partial_files(const fs::path& path) {
  const std::string start = path.filename().string() + std::string(kPartial);
  std::error_code error;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
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
  if (const int why = error_of_new_file(folder); why != 0) fail(folder, "cannot be written", why);
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
