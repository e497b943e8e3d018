#pragma once

#include <memory>
#include <string>

#include <samewhere/core/source.hpp>
#include <samewhere/twin/building/spec.hpp>
#include <samewhere/twin/front/config.hpp>
#include <samewhere/twin/front/walkthrough.hpp>

namespace samewhere::twin {

// A walk through a rendered building as a source: pictures (BGR, 640 x 480, 15 a second) of one
// camera or two, depth, inertial samples and exact truth. `spec` is
// "twin:PRESET?seed=3&similarity=0.9", see spec.hpp; throws InputError if it is not. The same spec
// and config give the same bytes. The next() of the first picture that is not kept takes a little
// longer: it computes the light. After an error every next() throws the same one. Pictures are kept
// in the folder that SAMEWHERE_CACHE names, if it does (picture_cache.hpp).
std::unique_ptr<core::Source> open_twin(const std::string& spec, const Config& config);

// The same of a walk that is there already. It must not be empty.
std::unique_ptr<core::Source> open_twin(std::shared_ptr<const Walkthrough> walk,
                                        const Config& config);

}  // namespace samewhere::twin
