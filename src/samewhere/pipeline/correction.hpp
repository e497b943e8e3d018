#pragma once

#include <string>

#include <samewhere/correct/loop_corrector.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::pipeline {

// What a loop made of a map.
struct Correction {
  scene::MapVersion map;
  correct::Closing closing;  // as it was carried out
};

// The map with one more loop: poses are solved (correct::close_loop), places that loops withdrawn
// for its sake had made one are parted, and what both ends of those that are believed from now on
// show is fused. A loop that is refused moves nothing. `overruled`: see close_loop.
Correction with_loop(const scene::MapVersion& map, const scene::LoopEdge& loop,
                     const Config& config, core::CandidateId overruled = {});

// Why a loop that the graph of loops does not believe is none.
std::string bent_by(const correct::OutlierLoop& bent, const Config& config);

}  // namespace samewhere::pipeline
