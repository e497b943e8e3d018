#pragma once

#include <cstdint>
#include <vector>

#include <samewhere/core/ids.hpp>

namespace samewhere::core {

// What a whole view looks like, as a vector of unit length (all zero for a view without any
// structure, such as a black image). Descriptors compare only if they come from the same describer:
// `describer_checksum` says which.
struct Descriptor {
  FrameId frame;
  std::vector<float> unit;
  std::uint64_t describer_checksum = 0;
};

}  // namespace samewhere::core
