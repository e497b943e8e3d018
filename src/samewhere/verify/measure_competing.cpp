#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Cholesky>

#include <samewhere/verify/measure_competing.hpp>
#include <samewhere/verify/measure_odometry.hpp>
#include <samewhere/verify/odometry_chain.hpp>

namespace samewhere::verify {
namespace {

// The youngest loop on the odometry chain that ends with this keyframe.
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

// The beginning of its odometry chain.
core::KeyframeId origin_of(const scene::MapVersion& map, core::KeyframeId keyframe) {
  while (map.at(keyframe).odometry) keyframe = map.at(keyframe).odometry->parent;
  return keyframe;
}

// Whether the map knows the pose of the claim's match relative to one end of the loop.
bool is_comparable(const scene::MapVersion& map, const scene::LoopEdge& claim,
                   const scene::LoopEdge& loop) {
  const core::KeyframeId origin = origin_of(map, claim.match);
  return origin == origin_of(map, loop.match) || origin == origin_of(map, loop.query);
}

// Negative log-likelihood terms of a claim under an odometry chain with normal errors.
struct Fit {
  double chi2 = 0.0;
  double log_det = 0.0;  // of the covariance
};

// A chain that is made longer at its beginning, with its constant errors.
class LongerChain {
 public:
  LongerChain(core::KeyframeId end, const SystematicDrift& bias) : chain_(end), systematic_(bias) {}

  core::KeyframeId begin() const { return chain_.begin(); }
  const OdometryChain& chain() const { return chain_.chain(); }
  core::Matrix6d systematic() const { return systematic_.covariance(); }
  // One edge more; false at the origin, which has none.
  bool climb(const scene::MapVersion& map) {
    const core::KeyframeId here = chain_.begin();
    if (!chain_.climb(map)) return false;
    systematic_.lengthen(map, here, chain_.begin());
    return true;
  }

 private:
  ClimbingChain chain_;
  DriftSum systematic_;
};

class Odometry {
 public:
  Odometry(const scene::MapVersion& map, const SystematicDrift& bias, const Config& config)
      : map_(map), bias_(bias), config_(config) {}
  Odometry(const Odometry&) = delete;
  Odometry& operator=(const Odometry&) = delete;

  // The chain leads to the query, from a keyframe that the map places relative to the match.
  // `systematic`: of its constant errors.
  Fit fit(const scene::LoopEdge& claim, const OdometryChain& chain,
          const core::Matrix6d& systematic) const {
    const core::Rigid3 claimed = inverse(world_from_body(map_, chain.begin)) *
                                 world_from_body(map_, claim.match) * claim.match_from_query;
    const core::Vector6d error = difference(chain.begin_from_end.a_from_b, claimed);
    const Eigen::LDLT<core::Matrix6d> covariance(chain.begin_from_end.covariance + systematic +
                                                 loop_information(config_).inverse());
    return {error.dot(covariance.solve(error)), covariance.vectorD().array().log().sum()};
  }

  std::optional<Fit> fit(const scene::LoopEdge& claim, core::KeyframeId begin) const {
    const auto chain = odometry_between(map_, begin, claim.query);
    if (!chain) return std::nullopt;
    return fit(claim, *chain, systematic_covariance(map_, chain->path, bias_));
  }
  LongerChain to(core::KeyframeId end) const { return {end, bias_}; }
  double chi2(const scene::LoopEdge& claim, const LongerChain& chain) const {
    return fit(claim, chain.chain(), chain.systematic()).chi2;
  }

 private:
  const scene::MapVersion& map_;
  SystematicDrift bias_;
  const Config& config_;
};

// The loops on a claim's odometry chain that contradict it, or agree with those that do.
struct Contradiction {
  const scene::LoopEdge* first = nullptr;
  // Query of the youngest loop that agrees with the claim; none if all contradict it.
  std::optional<core::KeyframeId> base;
};

// Far enough back, odometry would allow any two loops; so each loop is assigned to the one that it
// fits better.
Contradiction contradiction_of(const scene::MapVersion& map, const scene::LoopEdge& claim,
                               const Odometry& odometry, const Config& config) {
  std::map<core::KeyframeId, const scene::LoopEdge*> loop_of;
  for (const auto& loop : map.loops) loop_of.try_emplace(loop.query, &loop);
  Contradiction found;
  LongerChain to_claim = odometry.to(claim.query);
  LongerChain to_first = odometry.to(claim.query);
  do {
    const core::KeyframeId at = to_claim.begin();
    if (found.first != nullptr && to_first.begin() != at) to_first.climb(map);
    const auto loop = loop_of.find(at);
    if (loop == loop_of.end()) continue;
    const double chi2 = odometry.chi2(claim, to_claim);
    const bool is_with_claim =
        chi2 <= config.max_competing_chi_square &&
        (found.first == nullptr || chi2 <= odometry.chi2(*found.first, to_first));
    if (is_with_claim) {
      found.base = at;
      return found;
    }
    found.first = loop->second;
    to_first = odometry.to(at);
  } while (to_claim.begin() > claim.match && to_claim.climb(map));
  return found;
}

// Log-likelihood ratio, times two, of the claim over the first loop that contradicts it, under
// odometry without those loops. The larger covariance of a longer chain never counts for the claim.
void measure_gain(const scene::MapVersion& map, const scene::LoopEdge& claim,
                  const SystematicDrift& bias, const Config& config,
                  core::CompetingLoopEvidence& competing) {
  const Odometry odometry(map, bias, config);
  const Contradiction found = contradiction_of(map, claim, odometry, config);
  if (found.first == nullptr || claim.match >= found.first->query) return;
  const auto fit_of = [&](const scene::LoopEdge& loop) {
    const bool has_base = found.base && loop.match < *found.base;
    return odometry.fit(loop, has_base ? *found.base : loop.match);
  };
  const auto of_claim = fit_of(claim);
  const auto of_first = fit_of(*found.first);
  if (!of_claim || !of_first) return;
  competing.first_loop = found.first->cause;
  competing.gain =
      of_first->chi2 - of_claim->chi2 + std::min(0.0, of_first->log_det - of_claim->log_det);
}

// Without depth, loops have changed the scale of the odometry edges.
bool may_compare(const scene::MapVersion& map, const scene::LoopEdge& claim,
                 const core::CompetingLoopEvidence& competing, const ScaleErrors& scale,
                 const Config& config) {
  return competing.mahalanobis_squared > config.max_competing_chi_square && !has_scale_drift(map) &&
         measure_odometry_alone(map, claim, scale, config).mahalanobis_squared <=
             config.max_odometry_chi_square;
}

}  // namespace

std::optional<core::CompetingLoopEvidence> measure_competing_loop(const scene::MapVersion& map,
                                                                  const scene::LoopEdge& claim,
                                                                  const ScaleErrors& scale,
                                                                  const Config& config) {
  const scene::LoopEdge* loop = last_loop_before(map, claim.query);
  if (loop == nullptr || !is_comparable(map, claim, *loop)) return std::nullopt;
  scene::LoopEdge since_loop = claim;
  since_loop.match = loop->query;
  since_loop.match_from_query = inverse(world_from_body(map, loop->query)) *
                                world_from_body(map, claim.match) * claim.match_from_query;
  const core::OdometryEvidence found = measure_odometry_alone(map, since_loop, scale, config);
  core::CompetingLoopEvidence competing{.frame = map.at(loop->match).view.frame,
                                        .apart_m = found.correction_m,
                                        .apart_rad = found.correction_rad,
                                        .mahalanobis_squared = found.mahalanobis_squared};
  if (may_compare(map, claim, competing, scale, config))
    measure_gain(map, claim, scale.bias, config, competing);
  return competing;
}

std::optional<core::CompetingPlaceEvidence> measure_competing_place(const scene::MapVersion& map,
                                                                    const scene::LoopEdge& claim,
                                                                    const scene::LoopEdge& other,
                                                                    const ScaleErrors& scale,
                                                                    const Config& config) {
  const auto chain = odometry_between(map, other.match, claim.match);
  if (!chain) return std::nullopt;
  const core::Matrix6d of_loop = loop_information(config).inverse();
  const auto pose_of = [](const scene::LoopEdge& edge) {
    return core::Sim3{std::exp(edge.log_scale), edge.match_from_query.rotation,
                      edge.match_from_query.translation};
  };
  const core::Sim3 other_from_claim = pose_of(other) * inverse(pose_of(claim));
  const geometry::UncertainPose by_other{other.match_from_query, of_loop};
  const geometry::UncertainPose by_claim{claim.match_from_query, of_loop};
  const geometry::UncertainPose claimed = geometry::compose(by_other, geometry::inverse(by_claim));
  const geometry::UncertainPose known =
      expected_end(map, *chain, std::log(other_from_claim.scale),
                   {.creep = scale.creep, .loop = std::sqrt(2.0) * scale.loop, .bias = scale.bias});
  const core::Vector6d error = difference(known.a_from_b, rigid_part(other_from_claim));
  const core::Matrix6d covariance = known.covariance + claimed.covariance;
  if (error.dot(covariance.llt().solve(error)) <= config.max_competing_chi_square)
    return std::nullopt;
  const core::Rigid3 apart = inverse(world_from_body(map, claim.match) * claim.match_from_query) *
                             (world_from_body(map, other.match) * other.match_from_query);
  return core::CompetingPlaceEvidence{.frame = map.at(other.match).view.frame,
                                      .apart_m = apart.translation.norm(),
                                      .apart_rad = core::angle_rad(apart.rotation)};
}

}  // namespace samewhere::verify
