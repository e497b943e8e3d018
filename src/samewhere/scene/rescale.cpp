#include <cmath>
#include <utility>

#include <samewhere/core/errors.hpp>
#include <samewhere/scene/rescale.hpp>

namespace samewhere::scene {
namespace {

void scale(core::Rigid3& a_from_b, core::Matrix6d& information, double factor) {
  a_from_b.translation *= factor;
  information.topRows<3>() /= factor;
  information.leftCols<3>() /= factor;
}

void scale(Keyframe& keyframe, double own, double of_parent) {
  keyframe.log_scale += std::log(own);
  if (!keyframe.odometry) return;
  scale(keyframe.odometry->parent_from_keyframe, keyframe.odometry->information, of_parent);
  for (auto* parent_from_keyframe :
       {&keyframe.refined_parent_from_keyframe, &keyframe.settled_parent_from_keyframe,
        &keyframe.culled_parent_from_keyframe})
    if (*parent_from_keyframe) (*parent_from_keyframe)->translation *= of_parent;
}

void scale(std::vector<LoopEdge>& loops, const std::vector<double>& factors) {
  for (LoopEdge& loop : loops) {
    const double at_match = factors[loop.match.index()];
    scale(loop.match_from_query, loop.information, at_match);
    loop.log_scale += std::log(at_match / factors[loop.query.index()]);
  }
}

}  // namespace

void rescale(MapVersion& map, std::vector<double> factors) {
  core::require(factors.size() == map.keyframes.size(), "every keyframe has a factor");
  for (std::size_t i = 0; i < factors.size(); ++i) {
    const Keyframe& keyframe = map.keyframes[i];
    const double of_parent = keyframe.odometry ? factors[keyframe.odometry->parent.index()] : 1.0;
    if (!is_live(keyframe)) factors[i] = of_parent;
    core::require(factors[i] > 0.0, "a scale factor is positive");
    if (factors[i] != 1.0 || of_parent != 1.0) scale(map.keyframes.edit(i), factors[i], of_parent);
  }
  for (std::size_t i = 0; i < map.landmarks.size(); ++i) {
    const double factor = factors[map.landmarks[i].anchor.index()];
    if (factor == 1.0) continue;
    Landmark& landmark = map.landmarks.edit(i);
    landmark.position_in_anchor *= factor;
    landmark.range_m *= factor;
  }
  scale(map.loops, factors);
  scale(map.suspended_loops, factors);
}

}  // namespace samewhere::scene
