#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include <samewhere/core/open_file.hpp>

namespace samewhere::core {

// A file that is read in parts, such as one that is larger than the memory. Errors are InputErrors
// that begin with the path.
class FileReader {
 public:
  // Throws InputError if it is no file or cannot be read.
  explicit FileReader(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  // When it was opened, bytes.
  std::uint64_t size() const { return size_; }
  // Bytes [offset, offset + num_bytes) into `bytes`, which is resized. Throws InputError if the
  // file ends before. Memory is taken only for what the file has.
  void read(std::uint64_t offset, std::uint64_t num_bytes, std::string& bytes) const;
  std::string read(std::uint64_t offset, std::uint64_t num_bytes) const;

 private:
  std::filesystem::path path_;
  OpenFile file_;
  std::uint64_t size_ = 0;
};

// A file that is written from its beginning on and gets its name when it is complete; what the name
// referred to is there until then. It is removed if it was not published. Errors as above.
class FileStream {
 public:
  explicit FileStream(const std::filesystem::path& path);
  FileStream(const FileStream&) = delete;
  FileStream& operator=(const FileStream&) = delete;
  ~FileStream();

  const std::filesystem::path& path() const { return path_; }
  // Bytes written so far.
  std::uint64_t position() const { return position_; }
  void write(std::string_view bytes);
  // In place of what was written at `offset`, which has to reach as far.
  void overwrite(std::uint64_t offset, std::string_view bytes);
  void publish();

 private:
  [[noreturn]] void fail(int error) const;

  std::filesystem::path path_;
  std::filesystem::path partial_;  // its name until then; empty after that
  OpenFile file_;
  std::uint64_t position_ = 0;
};

}  // namespace samewhere::core
