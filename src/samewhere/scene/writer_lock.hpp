#pragma once

#include <filesystem>

namespace samewhere::scene {

// The right to write to a file, held by one program at a time: advisory (flock), given back when it
// is destroyed or the program ends, however it ends. Closing it would take SQLite's own locks on
// the same file along, so it outlives the connection.
class WriterLock {
 public:
  enum class File { kIsThere, kIsMade };
  // Throws InputError if somebody else writes to the file, or it cannot be opened to be written;
  // for kIsMade, if it is there already.
  WriterLock(const std::filesystem::path& path, File file);
  WriterLock(const WriterLock&) = delete;
  WriterLock& operator=(const WriterLock&) = delete;
  ~WriterLock();

 private:
  int descriptor_;
};

}  // namespace samewhere::scene
