#include "walk.hpp"

#include <samewhere/run/open_source.hpp>

namespace samewhere::bench {

Walk walk_of(const pipeline::Config& config) {
  const auto source = run::open_source(config);
  Walk walk{.info = source->info(), .frames = {}, .truth = {}};
  while (const auto frame = source->next()) walk.frames.push_back(*frame);
  walk.truth = source->truth();
  return walk;
}

}  // namespace samewhere::bench
