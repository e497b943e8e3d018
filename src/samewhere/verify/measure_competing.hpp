#pragma once

#include <optional>

#include <samewhere/core/verdict.hpp>
#include <samewhere/scene/map_version.hpp>
#include <samewhere/verify/map_drift.hpp>

namespace samewhere::verify {

// Competing hypothesis of an earlier loop: the last loop before the candidate `claim` on its
// odometry chain, or one of the query itself, has put the query at another place. Measured is how
// far from there the claim would put it, against the drift since that loop alone: what the map
// knows between the two places does not count, since a claim that only an error there could explain
// is a second place for one view. Nothing without an earlier loop, nor where nothing connects the
// match with it. Beyond max_competing_chi_square also the gain over the first of the loops that
// contradict the claim (docs/decisions/016, 023).
std::optional<core::CompetingLoopEvidence> measure_competing_loop(MapDrift& drift,
                                                                  const scene::LoopEdge& claim);

// Competing hypothesis of the same query: two claims whose matches odometry keeps apart
// (max_competing_chi_square), and the distance between the query's poses by both. Nothing if they
// can show one place, or if nothing connects them (docs/decisions/028).
std::optional<core::CompetingPlaceEvidence> measure_competing_place(MapDrift& drift,
                                                                    const scene::LoopEdge& claim,
                                                                    const scene::LoopEdge& other);

}  // namespace samewhere::verify
