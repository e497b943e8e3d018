#pragma once

#include <cstdint>
#include <vector>

#include <samewhere/core/ids.hpp>

namespace samewhere::core {

// Image descriptor: a vector of unit length (all zero for an image without structure, such as a
// black one). Descriptors are comparable only if they come from the same describer, named by
// `describer_checksum`.
struct Descriptor {
  FrameId frame;
  std::vector<float> unit;
  std::uint64_t describer_checksum = 0;
};

}  // namespace samewhere::core
