#pragma once

#include <vector>

#include <samewhere/core/frame.hpp>
#include <samewhere/core/source.hpp>
#include <samewhere/core/truth.hpp>
#include <samewhere/pipeline/config.hpp>

namespace samewhere::bench {

// A recording or a rendered walk, with all its pictures in memory: some GB for a minute.
struct Walk {
  core::SourceInfo info;
  std::vector<core::Frame> frames;
  core::Truth truth;
};

// Of config.source. Throws InputError.
Walk walk_of(const pipeline::Config& config);

}  // namespace samewhere::bench
