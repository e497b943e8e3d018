#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <samewhere/errors.hpp>
#include <samewhere/event.hpp>
#include <samewhere/types.hpp>

namespace samewhere {

/// Place recognition alone: which images show a place of an earlier image. Needs neither
/// calibration nor depth. Gives the verdicts of `samewhere loops`.
///
/// One thread at a time calls it. Errors as in Slam.
class LoopDetector {
 public:
  /// `settings`: "section.key=value", over profile `recognition`. `prior`: verify.prior; by default
  /// appearance alone accepts nothing. `frame_rate_hz`: turns the exclusion window
  /// retrieve.window_s into images. Throws InputError on a setting that cannot be used.
  explicit LoopDetector(const std::vector<std::string>& settings = {},
                        std::optional<Prior> prior = std::nullopt, double frame_rate_hz = 30.0);
  ~LoopDetector();
  LoopDetector(const LoopDetector&) = delete;
  LoopDetector& operator=(const LoopDetector&) = delete;

  /// The next image, of any size; frames are numbered from 0. Verdicts that are known now, on it
  /// and on earlier ones that waited for it. Throws InputError for an image without pixels, or of
  /// depth.
  std::vector<LoopVerdict> add(const Image& image);
  /// The input has ended: the verdicts on candidates that waited for more images.
  std::vector<LoopVerdict> finish();

 private:
  class Session;
  std::unique_ptr<Session> session_;
};

}  // namespace samewhere
