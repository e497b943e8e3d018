#pragma once

#include <functional>
#include <memory>

#include <samewhere/core/source.hpp>

namespace samewhere::input {

// For a live source: it is read in a thread of its own as fast as it gives, and next() is the
// newest of its frames. Those that had to make room are counted in Frame::num_dropped_before; ids
// count the frames given. An exception of the source comes out of next() after what it gave before.
// For sources without inertial samples: those of a dropped frame would be lost.
std::unique_ptr<core::Source> newest(std::unique_ptr<core::Source> source);

// Waits until so many seconds have passed since its first call. False: the frame that was to come
// then shall not come, nor any after it.
using WaitUntil = std::function<bool(double since_first_s)>;

// The same for a recording, as if it were live: each frame comes as long after the first as its
// stamp is, or as soon as it can be read, and the first on the first call. After Ctrl-C no more
// come, without waiting for the next. For sources whose truth does not refer to frame positions:
// truth() is that of all frames. An empty `wait` goes by the clock.
std::unique_ptr<core::Source> played(std::unique_ptr<core::Source> source, WaitUntil wait = {});

}  // namespace samewhere::input
