#pragma once

#include <string>

#include <samewhere/correct/loop_corrector.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::pipeline {

// A map after one more loop.
struct Correction {
  scene::MapVersion map;
  correct::Closing closing;  // as it was carried out
};

// The map with one more loop: pose graph optimization (correct::close_loop), withdrawal of
// contradicted loops with their effects, fusion of the landmarks at both ends of the accepted ones.
// A rejected loop changes nothing. `overruled`: see close_loop.
Correction with_loop(const scene::MapVersion& map, const scene::LoopEdge& loop,
                     const Config& config, core::CandidateId overruled = {});

// Reason for which the robust pose graph rejects the loop.
std::string bent_by(const correct::OutlierLoop& bent, const Config& config);

}  // namespace samewhere::pipeline
