#include <algorithm>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <opencv2/core/utility.hpp>

#include <samewhere/core/similarity.hpp>
#include <samewhere/describe/describer.hpp>
#include <samewhere/features/orb.hpp>
#include <samewhere/library/border.hpp>
#include <samewhere/library/convert.hpp>
#include <samewhere/library/frame_intake.hpp>
#include <samewhere/loop_verifier.hpp>
#include <samewhere/pipeline/map_context.hpp>
#include <samewhere/pipeline/verifier_settings.hpp>
#include <samewhere/verify/loop_verifier.hpp>

namespace samewhere {
namespace {

// Frames of the match and of the query.
constexpr core::FrameId kMatch{0};
constexpr core::FrameId kQuery{1};

// Two keyframes without landmarks, joined by odometry, if there is any.
scene::MapVersion map_of(const features::View& match, const features::View& query,
                         const std::optional<OdometryBetween>& odometry) {
  scene::Keyframe first{.id = core::KeyframeId(0), .view = match};
  scene::Keyframe second{.id = core::KeyframeId(1), .view = query};
  first.slots.resize(static_cast<std::size_t>(match.features->size()));
  second.slots.resize(static_cast<std::size_t>(query.features->size()));
  if (odometry) {
    second.world_from_body = library::rigid_of(odometry->match_from_query);
    second.odometry = {first.id, second.world_from_body, odometry->covariance.inverse()};
  }
  return scene::apply({}, scene::Edit{.keyframes = {std::move(first), std::move(second)}});
}

void check(const OdometryBetween& odometry) {
  if (!library::is_rigid(odometry.match_from_query))
    throw core::InputError(
        "odometry: match_from_query is not finite or no rotation; expected a rigid pose");
  if (!odometry.covariance.allFinite() || odometry.covariance.llt().info() != Eigen::Success)
    throw core::InputError(
        "odometry: the covariance is not positive definite; expected one of [m; rad]");
}

}  // namespace

struct LoopVerifier::Parts {
  Calibration calibration;
  pipeline::Config config;
  std::unique_ptr<describe::Describer> describer;

  struct Seen {
    core::Frame frame;
    features::View view;
  };
  // Stamps of the two frames have no order: each has an intake of its own.
  Seen seen(const Frame& frame, core::FrameId id) const {
    library::FrameIntake intake(calibration, config);
    intake.check(frame);
    Seen seen{intake.take(frame), {}};
    seen.frame.id = id;
    seen.view = features::extract(seen.frame, config.features);
    return seen;
  }
};

LoopVerifier::LoopVerifier(const Calibration& calibration, const std::vector<std::string>& settings,
                           std::optional<Prior> prior)
    : parts_(library::at_border([&] {
        cv::setNumThreads(1);
        const pipeline::Config config = library::config_of("default", settings, prior);
        auto parts = std::make_unique<Parts>(
            Parts{calibration, config, describe::make_describer(config.describe)});
        const library::FrameIntake checked(calibration, parts->config);
        return parts;
      })) {}

LoopVerifier::~LoopVerifier() = default;

LoopVerdict LoopVerifier::verify(const Frame& match, const Frame& query,
                                 const std::optional<OdometryBetween>& odometry) const {
  return library::at_border([&] {
    if (odometry) check(*odometry);
    const Parts::Seen old = parts_->seen(match, kMatch);
    const Parts::Seen now = parts_->seen(query, kQuery);
    const core::Candidate candidate{
        .id = core::CandidateId(0),
        .query = kQuery,
        .match = kMatch,
        .similarity = core::ncc(parts_->describer->describe(kQuery, now.frame.images[0]).unit,
                                parts_->describer->describe(kMatch, old.frame.images[0]).unit)};
    const scene::MapVersion map = map_of(old.view, now.view, odometry);
    const pipeline::KeyframeOf keyframe_of{{kMatch, core::KeyframeId(0)},
                                           {kQuery, core::KeyframeId(1)}};
    verify::OdometryTree tree = pipeline::odometry_tree(parts_->config);
    const pipeline::MapVersionContext by_odometry(map, tree, keyframe_of, kQuery, parts_->config);
    const verify::WithoutMap without_odometry;
    const verify::MapContext* context = &without_odometry;
    if (odometry) context = &by_odometry;
    const verify::LoopVerifier verifier(pipeline::loop_settings(parts_->config));
    const core::Evidence evidence = verifier.measure(candidate, now.view, old.view, *context, {});
    return library::verdict_of({candidate, verifier.decide(candidate, evidence, {})});
  });
}

}  // namespace samewhere
