#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace samewhere::twin {

// What was rendered for one frame.
struct Pictures {
  std::vector<cv::Mat> images;     // one per camera, 8-bit grey or BGR
  std::optional<cv::Mat> depth_m;  // 32-bit float, whole multiples of 1/5000 m below 13.1 m, 0 none
};

// Where pictures are kept, and how many.
struct CachePlace {
  std::filesystem::path root;
  std::uintmax_t max_bytes = 0;
};

// The folder of SAMEWHERE_CACHE with at most SAMEWHERE_CACHE_MB (10^6 bytes, 8192 if unset) in it;
// nothing if SAMEWHERE_CACHE is unset or empty. Throws InputError if the size is no whole number.
std::optional<CachePlace> cache_place_from_environment();

// Rendered pictures, kept on disk between runs, without loss. `key_text` names everything that they
// depend on: building, settings, version of the renderer. Below the root lies one folder per key,
// in it one file per frame, so that a frame is there with all its pictures or not at all. Files
// appear by renaming: processes that end suddenly or work on the same key at once do no harm. A
// damaged file counts as absent; so does a folder whose key file is missing or says something else,
// and its files go. If the root holds more than the limit, the keys that were used
// longest ago go, but never this one; the limit is looked at every few frames and may be passed by
// as many. Nothing here stops a run: where files cannot be written, the caller is told and goes on
// without. load and store may be called from several threads.
class PictureCache {
 public:
  explicit PictureCache(const std::string& key_text);  // at cache_place_from_environment()
  PictureCache(const std::string& key_text, const std::optional<CachePlace>& place);

  // Why nothing is kept although a place was named; nothing if all is well. One line to be logged.
  const std::optional<std::string>& refusal() const { return refusal_; }

  // What was found wrong and set right on opening; nothing if all is well. One line to be logged.
  const std::optional<std::string>& notice() const { return notice_; }

  std::optional<Pictures> load(int index) const;
  // Returns the reason if they could not be kept: one line, for the caller to log once.
  std::optional<std::string> store(int index, const Pictures& pictures) const;

 private:
  void open();
  std::optional<std::string> make_folder() const;  // the notice
  std::filesystem::path file_of(int index) const;
  void note_use() const;
  void make_room() const;

  std::optional<CachePlace> place_;  // nothing: the cache is off
  std::string key_text_;
  std::filesystem::path folder_;  // of the key
  std::optional<std::string> refusal_;
  std::optional<std::string> notice_;
};

}  // namespace samewhere::twin
