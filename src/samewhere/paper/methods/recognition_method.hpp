#pragma once

#include <memory>

#include <samewhere/paper/methods/method.hpp>
#include <samewhere/pipeline/config.hpp>

namespace samewhere::paper {

// Our recognition, as `samewhere loops` runs it. `config` has retrieve.window_frames. Throws
// InputError on settings that do not fit each other.
std::unique_ptr<Method> make_recognition_method(const pipeline::Config& config);

}  // namespace samewhere::paper
