#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <samewhere/errors.hpp>
#include <samewhere/types.hpp>

namespace samewhere {

// Frames of a recording of any format that `samewhere run` reads, or of a rendered building
// (twin:PRESET), as they were taken.
class Recording {
 public:
  // `source`: as for `samewhere run`. Settings: section `input`, `twin`. Throws InputError.
  explicit Recording(const std::string& source, const std::vector<std::string>& settings = {});
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  // Reads the first frame. Throws InputError if there is none, or no calibration.
  Calibration calibration();
  // The next frame; nothing at the end. Its images are valid until the next call. Throws InputError
  // on a damaged one.
  std::optional<Frame> next();

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace samewhere
