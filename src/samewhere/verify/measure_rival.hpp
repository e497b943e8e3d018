#pragma once

#include <optional>

#include <samewhere/core/verdict.hpp>
#include <samewhere/scene/map_version.hpp>
#include <samewhere/verify/config.hpp>
#include <samewhere/verify/measure_odometry.hpp>

namespace samewhere::verify {

// What the loop `claim` would have to be better than: the place where the last loop before it on
// the path, or one of the query itself, has put the camera already. How far from there the claim
// would put it, against the drift that odometry may have gathered since that loop alone, is the
// rival's. How well the map knows the way between both places does not count: a claim that only an
// error of that way could save is a second place for one view. Nothing where no loop came before:
// the first look-alike has no rival; nor where the match is of a part of the map that nothing joins
// with it. Beyond max_competing_chi_square, also how much likelier odometry makes the claim than
// the first of the loops on its path that contradict it (docs/decisions/023).
std::optional<core::RivalEvidence> measure_rival(const scene::MapVersion& map,
                                                 const scene::LoopEdge& claim,
                                                 const ScaleErrors& scale, const Config& config);

// Two claims about one view: how far apart they put it, if the map knows that they speak of two
// places, for odometry cannot have drifted so much between their matches
// (max_competing_chi_square). Nothing if they may be one place, or if nothing joins the two.
std::optional<core::OtherPlaceEvidence> measure_other_place(const scene::MapVersion& map,
                                                            const scene::LoopEdge& claim,
                                                            const scene::LoopEdge& other,
                                                            const ScaleErrors& scale,
                                                            const Config& config);

}  // namespace samewhere::verify
