#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace samewhere::core {

// The largest file of a kind that is read: checked before memory is taken and while reading, so
// that neither a sparse nor an endless file takes all of it. Each limit is far above what
// recordings have.
struct SizeLimit {
  std::uint64_t num_bytes;
  std::string_view kind;  // "a text file", as a message calls it
};
inline constexpr std::uint64_t kMegabyte = 1'000'000;
// YAML: ours have 20 KB, and a parser takes some hundred bytes for each of theirs
inline constexpr SizeLimit kSettingsLimit{kMegabyte, "a file of settings"};
// ours have 5 KB, and JSON takes up to 50 times its size while it is read
inline constexpr SizeLimit kTimingLimit{kMegabyte, "a timing.json"};
// a YAML parser takes up to 240 times its size; the largest, nerfstudio's transforms.json, lists
// all pictures, of which 5,000 have 3 MB
inline constexpr SizeLimit kCalibrationLimit{3 * kMegabyte, "a camera file"};
// lists and poses: those of an hour at 200 Hz have 60 MB
inline constexpr SizeLimit kTextLimit{128 * kMegabyte, "a text file"};
// the largest picture that is decoded (input/picture_size.hpp), uncompressed in 16-bit colour
inline constexpr SizeLimit kPictureLimit{400 * kMegabyte, "a picture"};
// large ones for one processor have 350 MB
inline constexpr SizeLimit kNetworkLimit{512 * kMegabyte, "a network or a vocabulary"};
// what the program wrote itself and reads as a whole: descriptors of views, pictures to learn from
inline constexpr SizeLimit kDataLimit{4096 * kMegabyte, "a file of descriptors or pictures"};

// Whether there is something (a folder) at that path. Throws InputError for a link that leads
// nowhere, naming it and where it leads: a disk that is not mounted is no missing file. The same
// for a folder on the way there.
bool is_there(const std::filesystem::path& path);
bool is_folder(const std::filesystem::path& path);

// For a library that opens files by their names. Throws InputError if there is none, or it is a
// pipe, a device, a socket or a folder, which would be waited for without end.
void require_file(const std::filesystem::path& path);

// Whether the path names what this process was given open: /dev/stdin, /dev/stdout, /dev/fd/3.
bool is_open_descriptor(const std::filesystem::path& path);

// "is a pipe, expected a file", from a file's st_mode.
std::string complaint_about_kind(unsigned mode);

}  // namespace samewhere::core
