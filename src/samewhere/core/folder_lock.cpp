#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/folder_lock.hpp>

namespace samewhere::core {

FolderLock::FolderLock(const std::filesystem::path& folder)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0)
    throw InputError(folder.string() + ": cannot be opened: " + std::strerror(errno));
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  ::close(descriptor_);
  throw InputError(folder.string() +
                   ": another program is writing into this folder; expected another one, or that "
                   "it has ended");
}

FolderLock::~FolderLock() { ::close(descriptor_); }

}  // namespace samewhere::core
