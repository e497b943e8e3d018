#pragma once

#include <memory>

#include <samewhere/core/source.hpp>

namespace samewhere::input {

// For a live source: it is read in a thread of its own as fast as it gives, and next() is the
// newest of its frames. Those that had to make room are counted in Frame::num_dropped_before; ids
// count the frames given. An exception of the source comes out of next() after what it gave before.
// For sources without inertial samples: those of a dropped frame would be lost.
std::unique_ptr<core::Source> newest(std::unique_ptr<core::Source> source);

}  // namespace samewhere::input
