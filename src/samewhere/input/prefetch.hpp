#pragma once

#include <memory>

#include <samewhere/core/source.hpp>

namespace samewhere::input {

// The same source, read one frame ahead in a thread of its own while the caller works on the last
// one. An exception of the source comes out of next() where the bad frame would have come; after it
// there are no more frames. It may be destroyed at any time. info() and truth() of `source` are
// called while its next() runs, so they must not look at what next() changes.
std::unique_ptr<core::Source> prefetched(std::unique_ptr<core::Source> source);

}  // namespace samewhere::input
