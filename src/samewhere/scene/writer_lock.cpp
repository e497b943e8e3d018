#include <cerrno>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/scene/writer_lock.hpp>

namespace samewhere::scene {
namespace {

constexpr mode_t kReadableByAll = 0644;

}  // namespace

WriterLock::WriterLock(const std::filesystem::path& path, File file)
    : descriptor_(::open(path.c_str(),
                         O_RDWR | O_CLOEXEC | (file == File::kIsMade ? O_CREAT | O_EXCL : 0),
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

WriterLock::~WriterLock() { ::close(descriptor_); }

}  // namespace samewhere::scene
