#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/map/full_bundle.hpp>
#include <samewhere/pipeline/by_hand.hpp>
#include <samewhere/pipeline/correction.hpp>
#include <samewhere/pipeline/map_export.hpp>
#include <samewhere/pipeline/run_folder.hpp>
#include <samewhere/pipeline/slam.hpp>
#include <samewhere/pipeline/withdrawal.hpp>
#include <samewhere/report/frames.hpp>
#include <samewhere/report/loops.hpp>
#include <samewhere/report/ply.hpp>
#include <samewhere/verify/measure_odometry.hpp>

namespace samewhere::pipeline {
namespace {

using core::InputError;
using scene::MapVersion;

constexpr const char* kByHand = "taken back by hand";

std::string name_of(const core::LedgerRow& row) {
  return fmt::format("candidate {}", row.candidate.id.index());
}

const scene::LoopEdge* edge_of(const std::vector<scene::LoopEdge>& loops, core::CandidateId cause) {
  const auto found = std::find_if(loops.begin(), loops.end(),
                                  [&](const auto& loop) { return loop.cause == cause; });
  return found == loops.end() ? nullptr : &*found;
}

bool holds(const MapVersion& map, core::CandidateId cause) {
  return edge_of(map.loops, cause) != nullptr || edge_of(map.doubted_loops, cause) != nullptr;
}

core::LedgerRow refused(core::LedgerRow row, const std::string& reason) {
  const core::Evidence evidence = core::evidence_of(row.verdict);
  row.verdict = core::Rejection{row.candidate.id, evidence, core::Refusal::kWithdrawn, reason};
  return row;
}

const scene::Keyframe& keyframe_of(const MapVersion& map, core::FrameId frame,
                                   const core::LedgerRow& row) {
  for (std::size_t i = 0; i < map.keyframes.size(); ++i)
    if (map.keyframes[i].view.frame == frame) return map.keyframes[i];
  throw InputError(
      fmt::format("{}: frame {} is no keyframe of the map", name_of(row), frame.index()));
}

core::Sim3 measured_pose(const core::LedgerRow& row) {
  if (core::is_loop(row.verdict))
    throw InputError(name_of(row) + " is a loop already; expected one that was refused");
  if (row.candidate.is_lost)
    throw InputError(name_of(row) +
                     " was taken for a view of which nobody knew where it is; expected a candidate "
                     "for a loop");
  const auto pose = report::match_from_query_of(row.verdict);
  if (!pose)
    throw InputError(
        fmt::format("{} has no relative pose ({}); expected one whose geometry was measured",
                    name_of(row), core::reason_of(row.verdict)));
  return *pose;
}

// Between the keyframes that the two views hang on by now.
scene::LoopEdge forced_edge(const MapVersion& map, const core::LedgerRow& row,
                            const Config& config) {
  const core::Sim3 match_from_query = measured_pose(row);
  const scene::Keyframe& query = keyframe_of(map, row.candidate.query, row);
  const scene::Keyframe& match = keyframe_of(map, row.candidate.match, row);
  if (query.log_scale != 0.0 || match.log_scale != 0.0)
    throw InputError(name_of(row) +
                     ": loops have changed the lengths of this map without depth since the pose "
                     "was measured");
  const auto edge =
      correct::between_holders(map, {query.id, match.id, rigid_part(match_from_query),
                                     verify::loop_information(config.verify), row.candidate.id,
                                     std::log(match_from_query.scale)});
  if (!edge) throw InputError(name_of(row) + ": one keyframe stands for both views by now");
  return *edge;
}

MapVersion bundled(MapVersion map, const Config& config) {
  map::BundleWindow window = map::window_of_all(map, config.map);
  if (window.free.empty()) return map;
  const scene::Edit edit =
      map::full_bundle(map, window, {config.map, config.features, config.optimize});
  return apply(std::move(map), edit);
}

const core::LedgerRow& row_of(const core::Ledger& ledger, std::size_t candidate,
                              const std::filesystem::path& folder) {
  if (candidate < ledger.size()) return ledger[candidate];
  throw InputError(fmt::format("{}: there is no candidate {}; expected 0 to {}", folder.string(),
                               candidate, static_cast<long>(ledger.size()) - 1));
}

// The rows of loops that another one has put in doubt know no evidence.
void add_evidence(core::Ledger& rows, const core::Ledger& ledger) {
  for (core::LedgerRow& row : rows) {
    const auto index = row.candidate.id.index();
    auto* rejection = std::get_if<core::Rejection>(&row.verdict);
    if (rejection == nullptr || index >= ledger.size()) continue;
    row.candidate = ledger[index].candidate;
    rejection->evidence = core::evidence_of(ledger[index].verdict);
  }
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

ByHand with_word(const MapVersion& map, const core::LedgerRow& row, Word word, const Config& config,
                 const std::filesystem::path& folder) {
  try {
    return word == Word::kReject ? rejected_by_hand(map, row, config)
                                 : forced_by_hand(map, row, config);
  } catch (const InputError& error) {
    throw InputError((folder / "loops.json").string() + ": " + error.what());
  }
}

void write_files(const std::filesystem::path& folder, const scene::StoredMap& stored,
                 const core::Ledger& ledger) {
  core::write_file(folder / "loops.json", report::loops_json(ledger));
  const core::Trajectory trajectory = trajectory_of(stored.map, stored.extras.frames);
  core::write_file(folder / "trajectory.tum", core::tum_text(trajectory));
  const std::string frames = core::read_file(folder / "frames.csv");
  core::write_file(folder / "frames.csv", report::with_poses(frames, trajectory));
  core::write_file(folder / "map.ply", report::ply_bytes(points_of(stored.map)));
}

}  // namespace

ByHand rejected_by_hand(const MapVersion& map, const core::LedgerRow& row, const Config& config) {
  const core::CandidateId cause = row.candidate.id;
  if (!core::is_loop(row.verdict) && !holds(map, cause))
    throw InputError(fmt::format("{} is no loop ({}, {}); expected one that was accepted",
                                 name_of(row), core::name_of(row.verdict),
                                 core::stage_of(row.verdict)));
  // without a pose, or between views that hang on one keyframe, it moved nothing
  return {holds(map, cause) ? without_loop(map, cause, config) : map, {refused(row, kByHand)}};
}

ByHand forced_by_hand(const MapVersion& map, const core::LedgerRow& row, const Config& config) {
  const core::CandidateId cause = row.candidate.id;
  const MapVersion& asked = holds(map, cause) ? without_loop(map, cause, config) : map;
  const scene::LoopEdge edge = forced_edge(asked, row, config);
  Correction correction = with_loop(asked, edge, config);
  if (const auto& bent = correction.closing.refused)
    throw InputError(
        fmt::format("{}: odometry and the other loops bend it by chi-square {:.1f}, above "
                    "optimize.loop_chi2 = {:.1f}; a larger one, or another optimize.loop_loss, "
                    "would take it",
                    name_of(row), bent->chi2, config.optimize.loop_chi2));
  core::LoopClosure loop{.candidate = cause, .evidence = core::evidence_of(row.verdict)};
  loop.match_from_query = report::match_from_query_of(row.verdict);
  loop.scale_is_free = loop.match_from_query->scale != 1.0;
  loop.information = edge.information;
  loop.is_by_hand = true;
  ByHand changed{bundled(std::move(correction.map), config), {{row.candidate, loop}}};
  for (const auto& bent : correction.closing.withdrawn)
    changed.rows.push_back(refused(
        {{.id = bent.loop.cause}, core::Rejection{}},
        fmt::format(
            "its edge is bent by chi-square {:.1f}, since candidate {} was accepted by hand",
            bent.chi2, cause.index())));
  return changed;
}

ChangedRun change_run(const std::filesystem::path& folder, std::size_t candidate, Word word,
                      const std::vector<std::string>& assignments) {
  const Config config = config_of_run(folder, assignments);
  core::Ledger ledger = ledger_of_run(folder);
  const core::LedgerRow& row = row_of(ledger, candidate, folder);
  scene::MapFile file = scene::MapFile::open(folder / "map.sw", scene::MapAccess::kExtend);
  scene::StoredMap stored = file.load();
  ByHand changed = with_word(stored.map, row, word, config, folder);
  add_evidence(changed.rows, ledger);
  ChangedRun result{changed.rows, stored.map.loops.size(), changed.map.loops.size(),
                    farthest_m(stored.map, changed.map)};
  scene::MapExtras news;
  for (const auto& changed_row : changed.rows) {
    news.ledger.push_back(report::ledger_row_json(changed_row));
    ledger[changed_row.candidate.id.index()] = changed_row;
  }
  stored.map = std::move(changed.map);
  file.commit(stored.map, news);
  write_files(folder, stored, ledger);
  return result;
}

}  // namespace samewhere::pipeline
