#include <algorithm>

#include <samewhere/verify/measure_odometry.hpp>
#include <samewhere/verify/measure_rival.hpp>

namespace samewhere::verify {
namespace {

// The youngest on the path of odometry that ends with this keyframe.
const scene::LoopEdge* last_loop_before(const scene::MapVersion& map, core::KeyframeId keyframe) {
  while (true) {
    const auto loop =
        std::find_if(map.loops.rbegin(), map.loops.rend(),
                     [&](const scene::LoopEdge& edge) { return edge.query == keyframe; });
    if (loop != map.loops.rend()) return &*loop;
    if (!map.at(keyframe).odometry) return nullptr;
    keyframe = map.at(keyframe).odometry->parent;
  }
}

// Where its path of odometry begins.
core::KeyframeId origin_of(const scene::MapVersion& map, core::KeyframeId keyframe) {
  while (map.at(keyframe).odometry) keyframe = map.at(keyframe).odometry->parent;
  return keyframe;
}

// Whether the map says anything of where the claim's match is from what the loop joins.
bool is_comparable(const scene::MapVersion& map, const scene::LoopEdge& claim,
                   const scene::LoopEdge& loop) {
  const core::KeyframeId origin = origin_of(map, claim.match);
  return origin == origin_of(map, loop.match) || origin == origin_of(map, loop.query);
}

}  // namespace

std::optional<core::RivalEvidence> measure_rival(const scene::MapVersion& map,
                                                 const scene::LoopEdge& claim, double scale_sigma,
                                                 const Config& config) {
  const scene::LoopEdge* loop = last_loop_before(map, claim.query);
  if (loop == nullptr || !is_comparable(map, claim, *loop)) return std::nullopt;
  scene::LoopEdge since_loop = claim;
  since_loop.match = loop->query;
  since_loop.match_from_query = inverse(world_from_body(map, loop->query)) *
                                world_from_body(map, claim.match) * claim.match_from_query;
  const core::OdometryEvidence found = measure_odometry(map, since_loop, scale_sigma, config);
  return core::RivalEvidence{.frame = map.at(loop->match).view.frame,
                             .apart_m = found.correction_m,
                             .apart_rad = found.correction_rad,
                             .mahalanobis_squared = found.mahalanobis_squared};
}

}  // namespace samewhere::verify
