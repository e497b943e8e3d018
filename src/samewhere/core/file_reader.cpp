#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <samewhere/core/draft.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file_kind.hpp>
#include <samewhere/core/file_reader.hpp>

namespace samewhere::core {
namespace {

std::filesystem::path partial_name(const std::filesystem::path& path) {
  std::filesystem::path name = path;
  name += fmt::format("{}{}-0", kPartial, ::getpid());
  return name;
}

}  // namespace

FileReader::FileReader(const std::filesystem::path& path) : path_(path), file_(-1) {
  require_file(path);
  file_ = OpenFile(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  struct stat status {};
  if (!file_.is_open() || ::fstat(file_.number(), &status) != 0)
    throw InputError(path.string() + ": cannot be read: " + std::strerror(errno));
  if (!S_ISREG(status.st_mode))
    throw InputError(path.string() + ": " + complaint_about_kind(status.st_mode));
  size_ = static_cast<std::uint64_t>(status.st_size);
}

void FileReader::read(std::uint64_t offset, std::uint64_t num_bytes, std::string& bytes) const {
  if (offset > size_ || num_bytes > size_ - offset) {
    throw InputError(fmt::format("{}: ends at byte {}, expected {} bytes at byte {}",
                                 path_.string(), size_, num_bytes, offset));
  }
  bytes.resize(static_cast<std::size_t>(num_bytes));
  std::size_t filled = 0;
  while (filled < bytes.size()) {
    const ssize_t got = ::pread(file_.number(), bytes.data() + filled, bytes.size() - filled,
                                static_cast<off_t>(offset + filled));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw InputError(path_.string() + ": cannot be read: " + std::strerror(errno));
    if (got == 0) throw InputError(path_.string() + ": became shorter while it was read");
    filled += static_cast<std::size_t>(got);
  }
}

std::string FileReader::read(std::uint64_t offset, std::uint64_t num_bytes) const {
  std::string bytes;
  read(offset, num_bytes, bytes);
  return bytes;
}

FileStream::FileStream(const std::filesystem::path& path)
    : path_(path), partial_(partial_name(path)), file_(-1) {
  file_ = OpenFile(
      ::open(partial_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0644));
  if (!file_.is_open()) fail(errno);
}

FileStream::~FileStream() {
  if (!partial_.empty()) ::unlink(partial_.c_str());
}

void FileStream::fail(int error) const {
  throw InputError(path_.string() + ": cannot be written: " + std::strerror(error));
}

void FileStream::write(std::string_view bytes) {
  if (const int error = file_.write(bytes); error != 0) fail(error);
  position_ += bytes.size();
}

void FileStream::overwrite(std::uint64_t offset, std::string_view bytes) {
  require(offset <= position_ && bytes.size() <= position_ - offset,
          "only written bytes are replaced");
  const ssize_t written =
      ::pwrite(file_.number(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
  if (written < 0) fail(errno);
  if (static_cast<std::size_t>(written) != bytes.size()) fail(EIO);
}

void FileStream::publish() {
  if (::fsync(file_.number()) != 0) fail(errno);
  if (const int error = file_.close(); error != 0) fail(error);
  if (::rename(partial_.c_str(), path_.c_str()) != 0) fail(errno);
  partial_.clear();
  sync_folder_of(path_);
}

}  // namespace samewhere::core
