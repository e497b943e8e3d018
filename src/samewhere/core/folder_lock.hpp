#pragma once

#include <filesystem>

namespace samewhere::core {

// The right to write results into a folder, held by one program at a time: advisory (flock on the
// folder itself, which leaves no file in it), given back when it is destroyed or the program ends,
// however it ends. On file systems without such locks it is always given.
class FolderLock {
 public:
  // Throws InputError if another program holds it, or the folder cannot be opened.
  explicit FolderLock(const std::filesystem::path& folder);
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();

 private:
  int descriptor_;
};

}  // namespace samewhere::core
