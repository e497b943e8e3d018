#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <samewhere/core/draft.hpp>
#include <samewhere/core/file_kind.hpp>

namespace samewhere::core {

// The whole file as bytes. Throws InputError if it cannot be read, is larger than `limit`, or is no
// file: a pipe by its name (one that the process was given open, such as /dev/fd/3, is read), a
// device, a socket or a folder. Throws Interrupted after Ctrl-C while a long one is read.
std::string read_file(const std::filesystem::path& path, const SizeLimit& limit = kTextLimit);

// The first bytes of a file, which tell what is in it: `num_bytes`, or fewer if it has no more.
// Nothing of what is no file, as of a pipe, from which they could not be read again. Throws
// InputError if the file cannot be read.
std::string read_beginning(const std::filesystem::path& path, std::size_t num_bytes);

// Writes the whole file or nothing: it gets its name when it is written (draft.hpp). A link is
// replaced, and that which it leads to stays. A pipe or a device is written to as it is, and so is
// what the process was given open
// (/dev/stdout). Throws InputError naming the path and the system's reason (no space left,
// permission denied).
void write_file(const std::filesystem::path& path, std::string_view content);

// The same in a folder that the program looks after, such as a run's: a pipe that has the name of a
// result is replaced, too, and a device refused.
void replace_file(const std::filesystem::path& path, std::string_view content);

// Writes a file that was not there, whole or not at all. Returns false if something has its name, a
// link, say. Throws InputError as write_file does.
bool write_new_file(const std::filesystem::path& path, std::string_view content);

// Files that tell of one thing. All are written, then all get their names, in the order in which
// they were added: a program that is killed or a disk that is full while they are written changes
// none of them.
class FilesTogether {
 public:
  // As write_file, but for the name: a pipe takes the bytes at once.
  void add(const std::filesystem::path& path, std::string_view content);
  void publish();

 private:
  std::vector<Draft> drafts_;
};

// Removes what killed programs left of `path`: temporary files of write_file. No other program may
// be writing it.
void remove_partial_files(const std::filesystem::path& path);

// Makes the folder and checks that files can be made in it, without leaving one. Throws InputError.
void make_writable_folder(const std::filesystem::path& folder);

// Makes a folder that was not there, with those on the way. False if something has its name: of two
// programs one alone makes it. Throws InputError.
bool make_new_folder(const std::filesystem::path& folder);

}  // namespace samewhere::core
