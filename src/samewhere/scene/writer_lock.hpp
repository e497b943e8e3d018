#pragma once

#include <cstdint>
#include <filesystem>

namespace samewhere::scene {

// The right to write to a file, held by one program at a time: advisory (flock), given back when it
// is destroyed or the program ends, however it ends. Closing it would take SQLite's own locks on
// the same file along, so it outlives the connection.
class WriterLock {
 public:
  enum class File { kIsThere, kIsMade };
  // Throws InputError if another program writes to the file, or it cannot be opened to be written;
  // for kIsMade, if it is there already.
  WriterLock(const std::filesystem::path& path, File file);
  // Whether another program holds it. False where the file cannot be read.
  static bool is_held(const std::filesystem::path& path);

  WriterLock(const WriterLock&) = delete;
  WriterLock& operator=(const WriterLock&) = delete;
  ~WriterLock();

  // Room on the disk for a file of so many bytes, which keeps its size until they are written.
  // Throws InputError if the disk has none. File systems that cannot promise it promise nothing.
  void reserve(std::uint64_t num_bytes);
  // After the disk had none: what was reserved and not written goes back.
  void give_back_room();

 private:
  std::filesystem::path path_;
  int descriptor_;
  bool was_refused_ = false;
};

}  // namespace samewhere::scene
