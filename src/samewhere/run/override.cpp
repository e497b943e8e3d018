#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/folder_lock.hpp>
#include <samewhere/core/match_from_query.hpp>
#include <samewhere/map/full_bundle.hpp>
#include <samewhere/pipeline/correction.hpp>
#include <samewhere/pipeline/withdrawal.hpp>
#include <samewhere/report/loops.hpp>
#include <samewhere/run/override.hpp>
#include <samewhere/run/run_folder.hpp>
#include <samewhere/run/run_lists.hpp>
#include <samewhere/verify/measure_odometry.hpp>

namespace samewhere::run {
namespace {

using core::InputError;
using scene::MapVersion;

std::string name_of(const core::LedgerRow& row) {
  return fmt::format("candidate {}", row.candidate.id.index());
}

// As an accepted or a suspended loop.
bool holds(const MapVersion& map, core::CandidateId cause) {
  const auto is_it = [&](const scene::LoopEdge& loop) { return loop.cause == cause; };
  return std::any_of(map.loops.begin(), map.loops.end(), is_it) ||
         std::any_of(map.suspended_loops.begin(), map.suspended_loops.end(), is_it);
}

core::LedgerRow refused(core::LedgerRow row, const std::string& reason) {
  const core::Evidence evidence = core::evidence_of(row.verdict);
  row.verdict = core::Rejection{row.candidate.id, evidence, core::Refusal::kWithdrawn, reason};
  return row;
}

core::LedgerRow accepted(core::LedgerRow row, const pipeline::Config& config, bool is_by_hand) {
  core::LoopClosure loop{.candidate = row.candidate.id, .evidence = core::evidence_of(row.verdict)};
  loop.match_from_query = core::match_from_query_of(row.verdict);
  loop.scale_is_free = loop.match_from_query && loop.match_from_query->scale != 1.0;
  loop.information = verify::loop_information(config.verify);
  loop.is_by_hand = is_by_hand;
  row.verdict = loop;
  return row;
}

// What the run knows of the loop.
core::LedgerRow known_of(const scene::LoopEdge& loop, const core::Ledger& ledger) {
  const auto found = std::find_if(ledger.begin(), ledger.end(), [&](const core::LedgerRow& row) {
    return row.candidate.id == loop.cause;
  });
  if (found != ledger.end()) return *found;
  throw InputError(fmt::format("the map has a loop of candidate {}, which loops.json does not have",
                               loop.cause.index()));
}

void require_not_lost(const core::LedgerRow& row) {
  if (row.candidate.origin != core::Origin::kRelocalization) return;
  throw InputError(name_of(row) + " is a relocalization candidate; expected a loop candidate");
}

const scene::Keyframe& keyframe_of(const MapVersion& map, core::FrameId frame,
                                   const core::LedgerRow& row) {
  if (const scene::Keyframe* keyframe = scene::keyframe_of(map, frame)) return *keyframe;
  throw InputError(
      fmt::format("{}: frame {} is no keyframe of the map", name_of(row), frame.index()));
}

core::Sim3 measured_pose(const core::LedgerRow& row) {
  if (core::is_loop(row.verdict))
    throw InputError(name_of(row) + " is a loop closure already; expected a rejected candidate");
  require_not_lost(row);
  const auto pose = core::match_from_query_of(row.verdict);
  if (!pose)
    throw InputError(fmt::format("{} has no relative pose ({}); expected a candidate with one",
                                 name_of(row), core::reason_of(row.verdict)));
  return *pose;
}

// Between the keyframes that the two views hang on by now.
scene::LoopEdge forced_edge(const MapVersion& map, const core::LedgerRow& row,
                            const pipeline::Config& config) {
  const core::Sim3 match_from_query = measured_pose(row);
  const scene::Keyframe& query = keyframe_of(map, row.candidate.query, row);
  const scene::Keyframe& match = keyframe_of(map, row.candidate.match, row);
  const double stretch = std::max(std::abs(query.log_scale), std::abs(match.log_scale));
  if (stretch > config.optimize.loop_scale_sigma)
    throw InputError(name_of(row) +
                     ": loops have changed the scale of this map without depth since its pose was "
                     "estimated");
  if (is_without_depth(map) && !is_live(match))
    throw InputError(
        fmt::format("{}: frame {} was culled as a keyframe, and without depth the "
                    "reference of its pose is unknown",
                    name_of(row), match.view.frame.index()));
  const auto edge =
      correct::between_holders(map, {query.id, match.id, rigid_part(match_from_query),
                                     verify::loop_information(config.verify), row.candidate.id,
                                     std::log(match_from_query.scale)});
  if (!edge) throw InputError(name_of(row) + ": query and match belong to the same keyframe");
  return *edge;
}

MapVersion bundled(MapVersion map, const pipeline::Config& config) {
  map::BundleWindow window = map::window_of_all(map, config.map);
  if (window.free.empty() || config.odometry.is_used()) return map;
  const scene::Edit edit =
      map::full_bundle(map, window, {config.map, config.features, config.optimize});
  return apply(std::move(map), edit);
}

double farthest_m(const MapVersion& before, const MapVersion& after) {
  double farthest = 0.0;
  for (std::size_t i = 0; i < before.keyframes.size(); ++i) {
    const core::KeyframeId id = before.keyframes[i].id;
    const Eigen::Vector3d step =
        world_from_body(after, id).translation - world_from_body(before, id).translation;
    farthest = std::max(farthest, step.norm());
  }
  return farthest;
}

OverriddenMap overridden(const scene::StoredMap& stored, const core::LedgerRow& row,
                         Override override_as, const core::Ledger& ledger,
                         const pipeline::Config& config) {
  const auto& keyframes = stored.map.keyframes;
  if (keyframes.empty() || keyframes.back().view.frame.session() != 0)
    throw InputError("its map holds several runs; expected the map of a single run");
  return override_as == Override::kReject ? with_rejected(stored.map, row, config)
                                          : with_forced(stored.map, row, ledger, config);
}

// An error of the work names the folder of the run.
template <class Work>
auto naming(const std::filesystem::path& folder, const Work& work) {
  try {
    return work();
  } catch (const InputError& error) {
    throw InputError(folder.string() + ": " + error.what());
  }
}

}  // namespace

OverriddenMap with_rejected(const MapVersion& map, const core::LedgerRow& row,
                            const pipeline::Config& config) {
  const core::CandidateId cause = row.candidate.id;
  require_not_lost(row);
  if (!core::is_loop(row.verdict) && !holds(map, cause))
    throw InputError(fmt::format("{} is no loop closure ({}, {}); expected an accepted candidate",
                                 name_of(row), core::name_of(row.verdict),
                                 core::stage_of(row.verdict)));
  // without a pose, or between views that hang on one keyframe, it moved nothing
  return {holds(map, cause) ? pipeline::without_loop(map, cause, config) : map,
          {refused(row, "withdrawn by hand")}};
}

OverriddenMap with_forced(const MapVersion& map, const core::LedgerRow& row,
                          const core::Ledger& ledger, const pipeline::Config& config) {
  const core::CandidateId cause = row.candidate.id;
  const scene::LoopEdge edge = forced_edge(map, row, config);
  const auto& competing = core::evidence_of(row.verdict).competing_loop;
  pipeline::Correction correction =
      pipeline::with_loop(holds(map, cause) ? pipeline::without_loop(map, cause, config) : map,
                          edge, config, competing ? competing->first_loop : core::CandidateId());
  const correct::Closing& closing = correction.closing;
  if (closing.rejected)
    throw InputError(
        fmt::format("{}: {}; a larger optimize.loop_chi2 or another "
                    "optimize.loop_loss would accept it",
                    name_of(row), pipeline::bent_by(*closing.rejected, config)));
  OverriddenMap changed{{}, {accepted(row, config, true)}};
  for (const auto& bent : closing.withdrawn)
    changed.rows.push_back(refused(known_of(bent.loop, ledger),
                                   fmt::format("{}, since {} was accepted by hand",
                                               pipeline::bent_by(bent, config), name_of(row))));
  for (const auto& loop : closing.accepted)
    if (loop.cause != cause)
      changed.rows.push_back(accepted(known_of(loop, ledger), config, false));
  changed.map = bundled(std::move(correction.map), config);
  return changed;
}

OverriddenRun override_run(const std::filesystem::path& folder, std::size_t candidate,
                           Override override_as, const std::vector<std::string>& assignments) {
  const core::FolderLock lock(folder);  // no run may replace what is there meanwhile
  const pipeline::Config config = config_of_run(folder, assignments);
  core::Ledger ledger = ledger_in_step(folder, &lock);
  const core::LedgerRow row = row_of(ledger, candidate, folder);
  const std::string frames_csv = core::read_file(folder / "frames.csv");
  const std::filesystem::path map = folder / "map.sw";
  if (!std::filesystem::exists(map))
    throw core::InputError(folder.string() +
                           ": has no map.sw, as a run of `loops`; expected a run of SLAM");
  scene::MapFile file = scene::MapFile::open(map, scene::MapAccess::kExtend);
  scene::StoredMap stored = file.load();
  stored.map.has_metric_odometry = config.odometry.is_used();
  OverriddenMap changed =
      naming(folder, [&] { return overridden(stored, row, override_as, ledger, config); });
  OverriddenRun result{changed.rows, stored.map.loops.size(), changed.map.loops.size(),
                       farthest_m(stored.map, changed.map)};
  scene::MapExtras news;
  for (const auto& changed_row : changed.rows) {
    news.ledger.push_back(report::ledger_row_json(changed_row));
    ledger[changed_row.candidate.id.index()] = changed_row;  // which came from there
  }
  stored.map = std::move(changed.map);
  const RunLists lists = naming(folder, [&] { return lists_of(stored, ledger, frames_csv); });
  file.commit(stored.map, news);
  write_lists(lists, folder);
  return result;
}

}  // namespace samewhere::run
