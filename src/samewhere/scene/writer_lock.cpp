#include <cerrno>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/sqlite.hpp>
#include <samewhere/scene/writer_lock.hpp>

namespace samewhere::scene {
namespace {

constexpr mode_t kReadableByAll = 0644;

}  // namespace

WriterLock::WriterLock(const std::filesystem::path& path, File file)
    : path_(path),
      descriptor_(
          ::open(path.c_str(),
                 O_RDWR | O_CLOEXEC | O_NONBLOCK | (file == File::kIsMade ? O_CREAT | O_EXCL : 0),
                 kReadableByAll)) {
  const auto refuse = [&](int error) {
    throw core::InputError(path.string() + ": cannot be opened to be written (" +
                           std::generic_category().message(error) + ")");
  };
  if (descriptor_ < 0) refuse(errno);
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  const int error = errno;
  ::close(descriptor_);
  if (error != EWOULDBLOCK) refuse(error);
  throw core::InputError(path.string() +
                         ": another program is writing to this map; expected that it has ended");
}

bool WriterLock::is_held(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return false;
  const bool is_held = ::flock(file, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(file);
  return is_held;
}

void WriterLock::reserve(std::uint64_t num_bytes) {
  // again each time: SQLite cuts the file to its size whenever the log is written into it
  if (::fallocate(descriptor_, FALLOC_FL_KEEP_SIZE, 0, static_cast<off_t>(num_bytes)) == 0) return;
  if (errno != ENOSPC && errno != EDQUOT) return;
  was_refused_ = true;
  throw core::NoSpace(path_);
}

void WriterLock::give_back_room() {
  struct stat status {};
  if (!was_refused_ || ::fstat(descriptor_, &status) != 0) return;
  if (::ftruncate(descriptor_, status.st_size) == 0) was_refused_ = false;
}

WriterLock::~WriterLock() { ::close(descriptor_); }

}  // namespace samewhere::scene
