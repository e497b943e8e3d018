#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/progress.hpp>
#include <samewhere/evaluate/depth_places.hpp>
#include <samewhere/evaluate/trajectory_error.hpp>
#include <samewhere/paper/place_truth.hpp>
#include <samewhere/run/open_source.hpp>

namespace samewhere::paper {
namespace {

bool has_depth_and_poses(const core::Source& source, const core::Truth& truth) {
  return source.info().has_depth && !truth.trajectory.empty();
}

[[noreturn]] void complain_of_no_places(const pipeline::Config& config) {
  throw core::InputError(fmt::format(
      "{}: nothing says which of its frames show the same place; expected same_place.pgm or "
      "same_place.txt beside the images, depth and true poses, or a twin building of a short walk",
      config.source));
}

}  // namespace

std::optional<core::PlaceTruthMatrix> places_by_depth(core::Source& source,
                                                      const core::Trajectory& truth) {
  core::Progress progress(source.info().name + ": depth read", source.info().num_frames);
  std::optional<core::Camera> camera;
  std::vector<std::optional<evaluate::DepthView>> views;
  while (const std::optional<core::Frame> frame = source.next()) {
    core::stop_if_interrupted();
    if (!frame->rig || frame->rig->cameras.empty()) return std::nullopt;
    camera = frame->rig->cameras.front();
    const auto pose = evaluate::truth_at(truth, frame->stamp_s);
    views.emplace_back();
    if (pose && frame->depth_m) views.back() = evaluate::DepthView{frame->depth_m->clone(), *pose};
    progress.update(static_cast<int>(views.size()));
  }
  if (!camera) return std::nullopt;
  return evaluate::places_from_depth(views, *camera);
}

core::Truth truth_with_places(const core::Source& source, const pipeline::Config& config) {
  core::Truth truth = source.truth();
  if (!truth.places && has_depth_and_poses(source, truth))
    truth.places = places_by_depth(*run::open_source(config), truth.trajectory);
  if (!truth.places) complain_of_no_places(config);
  return truth;
}

void require_place_truth(const core::Source& source, const pipeline::Config& config) {
  if (config.source.starts_with("twin:")) return;
  const core::Truth truth = source.truth();
  if (!truth.places && !has_depth_and_poses(source, truth)) complain_of_no_places(config);
}

}  // namespace samewhere::paper
