#pragma once

#include <functional>

#include <samewhere/core/link.hpp>
#include <samewhere/pipeline/messages.hpp>

namespace samewhere::pipeline {

// For tests and bench/: called in the stages of a Slam, in their threads. All may be empty.
struct SlamTestHooks {
  KeepMap keep_map = {};
  core::StageHook before_message = {};
  // May replace the loops in an answer of loop closing.
  std::function<void(const ToLoopClosing& question, LoopAnswer& answer)> alter_loops = {};
};

}  // namespace samewhere::pipeline
