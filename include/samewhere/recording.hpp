#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <samewhere/errors.hpp>
#include <samewhere/types.hpp>

namespace samewhere {

/// Frames of a recording of any format that `samewhere run` reads, or of a rendered building
/// (twin:PRESET), as they were taken.
class Recording {
 public:
  /// `source`: as for `samewhere run`. `settings`: "section.key=value", sections `input` and `twin`
  /// (docs/config.md). Throws InputError if the source or a setting cannot be used.
  explicit Recording(const std::string& source, const std::vector<std::string>& settings = {});
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  /// Cameras, depth and frame rate. Reads the first frame, which next() gives all the same. Throws
  /// InputError if there is no frame or no camera file.
  Calibration calibration();
  /// The next frame: images kGray8 or kBgr8, depth kDepthFloat. Nothing at the end. Its pixels are
  /// valid until the next call. Throws InputError on a damaged one.
  std::optional<Frame> next();

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace samewhere
