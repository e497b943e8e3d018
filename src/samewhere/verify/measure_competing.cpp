#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Cholesky>

#include <samewhere/verify/expected_end.hpp>
#include <samewhere/verify/measure_competing.hpp>
#include <samewhere/verify/measure_odometry.hpp>

namespace samewhere::verify {
namespace {

using LoopOf = std::map<core::KeyframeId, const scene::LoopEdge*>;  // by its query

// The first loop of each query.
LoopOf first_loops(const scene::MapVersion& map) {
  LoopOf loop_of;
  for (const auto& loop : map.loops) loop_of.try_emplace(loop.query, &loop);
  return loop_of;
}

// The youngest loop on the odometry path that ends with this keyframe; of one query the last.
const scene::LoopEdge* last_loop_before(MapDrift& drift, core::KeyframeId keyframe) {
  LoopOf loop_of;
  for (const auto& loop : drift.map().loops) loop_of[loop.query] = &loop;
  for (std::optional at(keyframe); at; at = drift.odometry().parent(*at)) {
    const auto loop = loop_of.find(*at);
    if (loop != loop_of.end()) return loop->second;
  }
  return nullptr;
}

// Whether the map knows the pose of the claim's match relative to one end of the loop.
bool is_comparable(MapDrift& drift, const scene::LoopEdge& claim, const scene::LoopEdge& loop) {
  const OdometryTree& odometry = drift.odometry();
  const core::KeyframeId origin = odometry.origin(claim.match);
  return origin == odometry.origin(loop.match) || origin == odometry.origin(loop.query);
}

// Negative log-likelihood terms of a claim under odometry with normal errors.
struct Fit {
  double chi2 = 0.0;
  double log_det = 0.0;  // of the covariance
};

// Odometry from `begin`, which the map places relative to the match, to the query. Nothing if it
// does not join the two.
std::optional<Fit> fit(MapDrift& drift, const scene::LoopEdge& claim, core::KeyframeId begin) {
  const auto known = drift.odometry().between(begin, claim.query);
  if (!known) return std::nullopt;
  const core::Rigid3 claimed = inverse(world_from_body(drift.map(), begin)) *
                               world_from_body(drift.map(), claim.match) * claim.match_from_query;
  const core::Vector6d error = difference(known->a_from_b, claimed);
  const Eigen::LDLT<core::Matrix6d> covariance(known->covariance +
                                               loop_information(drift.config()).inverse());
  return Fit{error.dot(covariance.solve(error)), covariance.vectorD().array().log().sum()};
}

// The loops on a claim's odometry path that contradict it, or agree with those that do.
struct Contradiction {
  const scene::LoopEdge* first = nullptr;
  // Query of the youngest loop that agrees with the claim; none if all contradict it.
  std::optional<core::KeyframeId> base;
};

// Far enough back, odometry would allow any two loops; so each loop is assigned to the one that it
// fits better.
Contradiction contradiction_of(MapDrift& drift, const scene::LoopEdge& claim) {
  const LoopOf loop_of = first_loops(drift.map());
  Contradiction found;
  for (std::optional at(claim.query); at; at = drift.odometry().parent(*at)) {
    const auto loop = loop_of.find(*at);
    if (loop != loop_of.end()) {
      const double chi2 = fit(drift, claim, *at)->chi2;
      if (chi2 <= drift.config().max_competing_chi_square &&
          (found.first == nullptr || chi2 <= fit(drift, *found.first, *at)->chi2)) {
        found.base = *at;
        return found;
      }
      found.first = loop->second;
    }
    if (*at <= claim.match) return found;
  }
  return found;
}

// Log-likelihood ratio, times two, of the claim over the first loop that contradicts it, under
// odometry without those loops. The larger covariance of a longer path never counts for the claim.
void measure_gain(MapDrift& drift, const scene::LoopEdge& claim,
                  core::CompetingLoopEvidence& competing) {
  const Contradiction found = contradiction_of(drift, claim);
  if (found.first == nullptr || claim.match >= found.first->query) return;
  const auto fit_of = [&](const scene::LoopEdge& loop) {
    const bool has_base = found.base && loop.match < *found.base;
    return fit(drift, loop, has_base ? *found.base : loop.match);
  };
  const auto of_claim = fit_of(claim);
  const auto of_first = fit_of(*found.first);
  if (!of_claim || !of_first) return;
  competing.first_loop = found.first->cause;
  competing.gain =
      of_first->chi2 - of_claim->chi2 + std::min(0.0, of_first->log_det - of_claim->log_det);
}

// Without depth, loops have changed the scale of the odometry edges.
bool may_compare(MapDrift& drift, const scene::LoopEdge& claim,
                 const core::CompetingLoopEvidence& competing) {
  const Config& config = drift.config();
  return competing.mahalanobis_squared > config.max_competing_chi_square &&
         !has_scale_drift(drift.map()) &&
         measure_odometry_alone(drift, claim).mahalanobis_squared <= config.max_odometry_chi_square;
}

}  // namespace

std::optional<core::CompetingLoopEvidence> measure_competing_loop(MapDrift& drift,
                                                                  const scene::LoopEdge& claim) {
  const scene::MapVersion& map = drift.map();
  const scene::LoopEdge* loop = last_loop_before(drift, claim.query);
  if (loop == nullptr || !is_comparable(drift, claim, *loop)) return std::nullopt;
  scene::LoopEdge since_loop = claim;
  since_loop.match = loop->query;
  since_loop.match_from_query = inverse(world_from_body(map, loop->query)) *
                                world_from_body(map, claim.match) * claim.match_from_query;
  const core::OdometryEvidence found = measure_odometry_alone(drift, since_loop);
  core::CompetingLoopEvidence competing{.frame = map.at(loop->match).view.frame,
                                        .apart_m = found.correction_m,
                                        .apart_rad = found.correction_rad,
                                        .mahalanobis_squared = found.mahalanobis_squared};
  if (may_compare(drift, claim, competing)) measure_gain(drift, claim, competing);
  return competing;
}

std::optional<core::CompetingPlaceEvidence> measure_competing_place(MapDrift& drift,
                                                                    const scene::LoopEdge& claim,
                                                                    const scene::LoopEdge& other) {
  const core::Matrix6d of_loop = loop_information(drift.config()).inverse();
  const auto pose_of = [](const scene::LoopEdge& edge) {
    return core::Sim3{std::exp(edge.log_scale), edge.match_from_query.rotation,
                      edge.match_from_query.translation};
  };
  const core::Sim3 other_from_claim = pose_of(other) * inverse(pose_of(claim));
  const auto known =
      expected_end(drift, other.match, claim.match, std::log(other_from_claim.scale),
                   {.creep = drift.scale().creep, .loop = std::sqrt(2.0) * drift.scale().loop});
  if (!known) return std::nullopt;
  const geometry::UncertainPose by_other{other.match_from_query, of_loop};
  const geometry::UncertainPose by_claim{claim.match_from_query, of_loop};
  const geometry::UncertainPose claimed = geometry::compose(by_other, geometry::inverse(by_claim));
  const core::Vector6d error = difference(known->a_from_b, rigid_part(other_from_claim));
  const core::Matrix6d covariance = known->covariance + claimed.covariance;
  if (error.dot(covariance.llt().solve(error)) <= drift.config().max_competing_chi_square)
    return std::nullopt;
  const scene::MapVersion& map = drift.map();
  const core::Rigid3 apart = inverse(world_from_body(map, claim.match) * claim.match_from_query) *
                             (world_from_body(map, other.match) * other.match_from_query);
  return core::CompetingPlaceEvidence{.frame = map.at(other.match).view.frame,
                                      .apart_m = apart.translation.norm(),
                                      .apart_rad = core::angle_rad(apart.rotation)};
}

}  // namespace samewhere::verify
