#pragma once

#include <stdexcept>

/// The interface of libsamewhere. Messages of its errors are one line.
namespace samewhere {

/// Bad input: a frame, a calibration, a setting or a file. The message names it, the value found
/// and what was expected. A frame that is refused changes nothing: the next call may follow.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A call that is not allowed now: a frame after finish(), two threads in track() at once, or any
/// call after an internal error. The message says whether the session goes on.
class UsageError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

}  // namespace samewhere
