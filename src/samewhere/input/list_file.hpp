#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <samewhere/core/text_file.hpp>

namespace samewhere::input {

// Lists of pictures: text files whose lines name files relative to a folder. A name may hold
// blanks, bare or in quotes, if there is a file of that name.

struct ListedFile {
  std::string name;  // as the list has it; if there is no such file, all that the line could mean
  std::filesystem::path path;
  bool is_there = false;
};

// The file that `text` begins with: its first word; or what stands in quotes; or the longest run of
// words that is a file. Commas end words, too, and backslashes may stand for slashes.
ListedFile listed_file(const std::filesystem::path& folder, std::string_view text);

struct StampedFile {
  std::string place;  // of its line, for messages
  double stamp_s = 0.0;
  ListedFile file;
};

// Lines `stamp filename` or `stamp,filename`, as rgb.txt and depth.txt of TUM RGB-D have. Throws
// InputError naming the line if one has no stamp or name, or if stamps do not rise.
std::vector<StampedFile> read_stamped_files(const std::filesystem::path& list);

// Two files of one moment, or of nearly one.
struct StampedPair {
  StampedFile colour;
  StampedFile depth;
};

// Lines `stamp filename stamp filename`, as associate.py of the TUM RGB-D benchmark writes; the
// file of the depth may come first. Throws InputError naming the line if one is anything else, or
// if the colour stamps do not rise.
std::vector<StampedPair> read_associations(const std::filesystem::path& list);

}  // namespace samewhere::input
