#pragma once

#include <memory>
#include <optional>
#include <string>

#include <opencv2/core/types.hpp>

#include <samewhere/core/source.hpp>

namespace samewhere::input {

// A camera of pictures without calibration: a pinhole with square pixels, its centre in the middle,
// without distortion.
struct GuessedCamera {
  core::PinholeRadtan camera;
  std::string reason;  // what the focal length rests on, as the end of a sentence
};

// Of the longer side; phones, webcams and depth cameras lie between 55 and 70.
inline constexpr double kGuessedView_deg = 62.0;

// By what is known first: the horizontal field of view (`fov_deg`, 0: not given), the focal length
// in 35 mm of the pictures' EXIF data (nothing: not given), or the size alone. Throws InputError if
// the first gives no usable pinhole.
GuessedCamera guess_camera(const cv::Size& size_px, double fov_deg, std::optional<double> film_mm);

// The first frame of a source, which still gives it; nothing if it has none.
struct Peeked {
  std::unique_ptr<core::Source> source;
  std::optional<core::Frame> first;
};
Peeked peek(std::unique_ptr<core::Source> source);

// The same source, of one camera, with the calibration that it lacks.
std::unique_ptr<core::Source> with_camera(std::unique_ptr<core::Source> source,
                                          const core::PinholeRadtan& camera);

}  // namespace samewhere::input
