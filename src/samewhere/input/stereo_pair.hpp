#pragma once

#include <string>

#include <samewhere/core/result.hpp>
#include <samewhere/core/rigid3.hpp>
#include <samewhere/messages/messages.hpp>

namespace samewhere::input {

// Where the right camera of a pair is, as the pair was calibrated: R turns each camera to the axes
// of the rectified pair, P of the right one has its place along them. `is_rectified`: the pictures
// have those axes. R of zeros, as cameras that are not calibrated have it, turns nothing. Refused
// in one line if P tells of no distance between the cameras, or R is no rotation.
Result<core::Rigid3, std::string> left_from_right(const messages::CameraInfo& left,
                                                  const messages::CameraInfo& right,
                                                  bool is_rectified);

}  // namespace samewhere::input
