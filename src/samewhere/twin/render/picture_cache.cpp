#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <tuple>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <stdlib.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/twin/render/picture_cache.hpp>
#include <samewhere/twin/render/picture_file.hpp>

namespace samewhere::twin {
namespace {

using std::filesystem::path;
using FileTime = std::filesystem::file_time_type;

constexpr const char* kKeyFile = "key.txt";     // its time is when the key was last used
constexpr const char* kPictures = ".pictures";  // how the name of a frame's file ends
constexpr std::size_t kNameDigits = 16;
constexpr int kFramesBetweenChecks = 32;
constexpr std::string_view kMagic = "samewhere pictures 1\n";
constexpr std::string_view kDepth = "depth";
constexpr std::string_view kImage = "image";

// FNV-1a (Fowler, Noll, Vo), 64 bits. Two keys that share a folder name are told apart by the key
// file, and the later takes the place of the earlier.
std::string name_of_key(std::string_view key_text) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : key_text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return fmt::format("{:016x}", hash);
}

// ---- one file: kMagic, then for each picture a line `KIND NUM_BYTES` and its PNG file; at the end
// a line `end 0`, without which it was cut short

void append_part(std::string_view kind, std::string_view png, std::string& file) {
  file += fmt::format("{} {}\n", kind, png.size());
  file += png;
}

std::string file_content(const Pictures& pictures) {
  std::string file(kMagic);
  for (const cv::Mat& image : pictures.images) {
    append_part(kImage, png_bytes(image), file);
  }
  if (pictures.depth_m) {
    const cv::Mat units = depth_units(*pictures.depth_m);
    core::require(cv::norm(depth_of_units(units), *pictures.depth_m, cv::NORM_INF) == 0.0,
                  "cached depth comes in whole units of 1/5000 m");
    append_part(kDepth, png_bytes(units), file);
  }
  append_part("end", "", file);
  return file;
}

struct Part {
  std::string_view kind;
  std::string_view bytes;
};

// Takes the next part off the front of `rest`; nothing if there is no whole one.
std::optional<Part> take_part(std::string_view& rest) {
  const std::string_view line = rest.substr(0, rest.find('\n'));
  const std::size_t space = line.find(' ');
  if (line.size() == rest.size() || space == std::string_view::npos) return std::nullopt;
  std::size_t num_bytes = 0;
  const char* const last = line.data() + line.size();
  const auto [end, error] = std::from_chars(line.data() + space + 1, last, num_bytes);
  const std::string_view after = rest.substr(line.size() + 1);
  if (error != std::errc{} || end != last || num_bytes > after.size()) return std::nullopt;
  rest = after.substr(num_bytes);
  return Part{line.substr(0, space), after.substr(0, num_bytes)};
}

bool add_part(const Part& part, Pictures& pictures) {
  std::optional<cv::Mat> picture = picture_of_png(part.bytes);
  if (!picture) return false;
  const bool is_depth = picture->type() == CV_16UC1;
  if (part.kind != (is_depth ? kDepth : kImage)) return false;
  if (is_depth) {
    pictures.depth_m = depth_of_units(*picture);
  } else {
    pictures.images.push_back(*std::move(picture));
  }
  return true;
}

std::optional<Pictures> pictures_of(std::string_view file) {
  if (!file.starts_with(kMagic)) return std::nullopt;
  std::string_view rest = file.substr(kMagic.size());
  Pictures pictures;
  while (const std::optional<Part> part = take_part(rest)) {
    if (part->kind == "end" && rest.empty()) return pictures;
    if (!add_part(*part, pictures)) return std::nullopt;
  }
  return std::nullopt;
}

// ---- files

std::optional<std::string> read_if_there(const path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return std::nullopt;
  try {
    return core::read_file(file, core::kPictureLimit);
  } catch (const core::InputError&) {  // gone again, or not ours to read
    return std::nullopt;
  }
}

bool write_all(int file, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(file, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

// Unlike core::write_file: a temporary name that no other process has, and no waiting for the disk
// (what a power cut damages is rendered again). Returns the system's error number.
int replace_file(const path& file, std::string_view content) {
  std::string temporary = file.string() + ".XXXXXX";
  const int descriptor = ::mkstemp(temporary.data());
  if (descriptor < 0) return errno;
  int error = write_all(descriptor, content) ? 0 : errno;
  if (::close(descriptor) != 0 && error == 0) error = errno;
  if (error == 0 && ::rename(temporary.c_str(), file.c_str()) != 0) error = errno;
  if (error != 0) ::unlink(temporary.c_str());
  return error;
}

// Returns how many there were.
int drop_pictures(const path& folder) {
  int num_dropped = 0;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->path().extension() != kPictures) continue;
    std::error_code gone;
    if (std::filesystem::remove(entry->path(), gone)) ++num_dropped;
  }
  return num_dropped;
}

// ---- room

struct KeyFolder {
  FileTime last_use;
  std::uintmax_t num_bytes = 0;
  path folder;
};

std::uintmax_t bytes_in(const path& folder) {
  std::uintmax_t sum = 0;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code gone;
    const std::uintmax_t num_bytes = entry->file_size(gone);
    if (!gone) sum += num_bytes;
  }
  return sum;
}

// Only what is surely ours: a person may have named a folder that holds other things too.
bool is_key_folder(const path& folder) {
  const std::string name = folder.filename().string();
  std::error_code error;
  return name.size() == kNameDigits &&
         name.find_first_not_of("0123456789abcdef") == std::string::npos &&
         std::filesystem::exists(folder / kKeyFile, error);
}

std::vector<KeyFolder> key_folders(const path& root) {
  std::vector<KeyFolder> folders;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(root, error), end; !error && entry != end;
       entry.increment(error)) {
    if (!is_key_folder(entry->path())) continue;
    std::error_code gone;
    const FileTime last_use = std::filesystem::last_write_time(entry->path() / kKeyFile, gone);
    folders.push_back({gone ? FileTime::min() : last_use, bytes_in(entry->path()), entry->path()});
  }
  return folders;
}

}  // namespace

std::optional<CachePlace> cache_place_from_environment() {
  constexpr std::uintmax_t kDefault_mb = 8192;
  constexpr std::uintmax_t kBytes_per_mb = 1'000'000;
  constexpr std::uintmax_t kMax_mb = 1'000'000'000;
  const char* const root = std::getenv("SAMEWHERE_CACHE");
  if (root == nullptr || *root == '\0') return std::nullopt;
  std::uintmax_t limit_mb = kDefault_mb;
  if (const char* const text = std::getenv("SAMEWHERE_CACHE_MB")) {
    const std::string_view word(text);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), limit_mb);
    if (error != std::errc{} || end != word.data() + word.size() || limit_mb > kMax_mb) {
      throw core::InputError(
          fmt::format("SAMEWHERE_CACHE_MB = {}: expected a whole number of megabytes, at most {}",
                      word, kMax_mb));
    }
  }
  return CachePlace{root, limit_mb * kBytes_per_mb};
}

PictureCache::PictureCache(const std::string& key_text)
    : PictureCache(key_text, cache_place_from_environment()) {}

PictureCache::PictureCache(const std::string& key_text, const std::optional<CachePlace>& place)
    : place_(place), key_text_(key_text) {
  if (!place_) return;
  try {
    open();
  } catch (const core::InputError& error) {
    refusal_ = fmt::format("pictures are not cached: {}", error.what());
    place_.reset();
  }
}

void PictureCache::open() {
  folder_ = place_->root / name_of_key(key_text_);
  notice_ = make_folder();
  note_use();
  make_room();
}

std::optional<std::string> PictureCache::make_folder() const {
  std::error_code failed;
  std::filesystem::create_directories(folder_, failed);
  if (failed) throw core::InputError(folder_.string() + ": cannot be made: " + failed.message());
  const path key_file = folder_ / kKeyFile;
  const std::optional<std::string> found = read_if_there(key_file);
  if (found && *found == key_text_) return std::nullopt;
  // the content of its images is unknown
  const int num_dropped = drop_pictures(folder_);
  if (const int error = replace_file(key_file, key_text_); error != 0) {
    throw core::InputError(
        fmt::format("{}: cannot be written: {}", key_file.string(), std::strerror(error)));
  }
  if (!found && num_dropped == 0) return std::nullopt;
  return fmt::format("{}: {}; its pictures ({}) are rendered anew", key_file.string(),
                     found ? "is cut short or of other pictures" : "is missing", num_dropped);
}

path PictureCache::file_of(int index) const {
  return folder_ / fmt::format("{:06}{}", index, kPictures);
}

void PictureCache::note_use() const {
  std::error_code ignored;  // then it goes a little earlier
  std::filesystem::last_write_time(folder_ / kKeyFile, FileTime::clock::now(), ignored);
}

void PictureCache::make_room() const {
  std::vector<KeyFolder> folders = key_folders(place_->root);
  std::sort(folders.begin(), folders.end(), [](const KeyFolder& a, const KeyFolder& b) {
    return std::tie(a.last_use, a.folder) < std::tie(b.last_use, b.folder);
  });
  std::uintmax_t sum = 0;
  for (const KeyFolder& key : folders) sum += key.num_bytes;
  for (const KeyFolder& key : folders) {
    if (sum <= place_->max_bytes) return;
    if (key.folder == folder_) continue;
    std::error_code ignored;  // another process may be at it
    std::filesystem::remove_all(key.folder, ignored);
    sum -= key.num_bytes;
  }
}

std::optional<Pictures> PictureCache::load(int index) const {
  core::require(index >= 0, "frames count from 0");
  if (!place_) return std::nullopt;
  const std::optional<std::string> file = read_if_there(file_of(index));
  if (!file) return std::nullopt;
  if (index % kFramesBetweenChecks == 0) note_use();
  return pictures_of(*file);
}

std::optional<std::string> PictureCache::store(int index, const Pictures& pictures) const {
  core::require(index >= 0, "frames count from 0");
  if (!place_) return std::nullopt;
  const std::string content = file_content(pictures);
  // frames are about as large as each other, and come in their order
  const std::uintmax_t expected_bytes = content.size() * (static_cast<std::uintmax_t>(index) + 1);
  if (expected_bytes > place_->max_bytes) {
    return fmt::format(
        "pictures from frame {} on are not cached: they would pass the limit of {} "
        "MB (SAMEWHERE_CACHE_MB)",
        index, place_->max_bytes / 1'000'000);
  }
  if (const int error = replace_file(file_of(index), content); error == ENOENT) {
    // the folder was cleared: continues with the next frame
    try {
      make_folder();
    } catch (const core::InputError& refused) {
      return fmt::format("pictures are not cached: {}", refused.what());
    }
  } else if (error != 0) {
    return fmt::format("pictures are not cached: {}: {}", file_of(index).string(),
                       std::strerror(error));
  }
  if (index % kFramesBetweenChecks == 0) {
    note_use();
    make_room();
  }
  return std::nullopt;
}

}  // namespace samewhere::twin
