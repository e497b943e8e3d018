#pragma once

#include <memory>
#include <string>

#include <samewhere/core/source.hpp>
#include <samewhere/twin/config.hpp>
#include <samewhere/twin/spec.hpp>

namespace samewhere::twin {

// A walk through a rendered building as a source: pictures (BGR, 640 x 480, 15 a second), depth and
// exact truth. `spec` is "twin:PRESET?seed=3&similarity=0.9", see spec.hpp; throws InputError if it
// is not. The same spec and config give the same bytes. The first next() takes a little longer: it
// computes the light.
std::unique_ptr<core::Source> open_twin(const std::string& spec, const Config& config);

}  // namespace samewhere::twin
