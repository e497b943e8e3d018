#pragma once

#include <memory>

#include <samewhere/run/watcher.hpp>
#include <samewhere/slam.hpp>

namespace samewhere::library {

// A session that tells a watcher, if any, of itself and of those that follow it by load() and
// reset(). The frames are those of a live source: they do not wait. The watcher outlives the
// session. Throws as Slam's constructor does.
std::unique_ptr<Slam> watched_slam(const Calibration& calibration, const Options& options,
                                   run::Watcher* watcher);

}  // namespace samewhere::library
