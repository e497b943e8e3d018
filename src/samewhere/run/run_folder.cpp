#include <algorithm>
#include <limits>
#include <sstream>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/evaluate/tower_walk.hpp>
#include <samewhere/evaluate/trajectory_error.hpp>
#include <samewhere/features/match_pair.hpp>
#include <samewhere/report/figure.hpp>
#include <samewhere/report/frames.hpp>
#include <samewhere/report/timing_json.hpp>
#include <samewhere/run/open_source.hpp>
#include <samewhere/run/run_folder.hpp>
#include <samewhere/run/run_lists.hpp>
#include <samewhere/run/run_metrics.hpp>
#include <samewhere/scene/map_file.hpp>

namespace samewhere::run {
namespace {

// Frames are counted by int.
constexpr std::uint64_t kMaxFrame = std::numeric_limits<int>::max();

std::vector<report::ScoredPair> read_pairs(const std::filesystem::path& path) {
  std::istringstream lines(core::read_file(path));
  std::vector<report::ScoredPair> pairs;
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line);
    std::uint64_t query = 0;
    std::uint64_t match = 0;
    double score = 0.0;
    const bool has_all = static_cast<bool>(words >> query >> match >> score);
    if (!has_all || query > kMaxFrame || match > kMaxFrame) {
      throw core::InputError(fmt::format(
          "{}, line {}: expected `query match score`, of which the first two are numbers of frames",
          path.string(), number));
    }
    pairs.push_back({core::FrameId(query), core::FrameId(match), score});
  }
  return pairs;
}

SlamFindings read_slam_findings(const std::filesystem::path& folder, bool is_scale_free) {
  const core::Ledger ledger = ledger_of_run(folder);  // first: it brings the other lists in step
  const report::FrameTimes frames = report::read_frames_csv(folder / "frames.csv");
  SlamFindings findings;
  findings.num_frames = static_cast<int>(frames.stamps_s.size());
  findings.trajectory = core::read_tum(folder / "trajectory.tum");
  findings.odometry = core::read_tum(folder / "odometry.tum");
  findings.is_scale_free = is_scale_free;
  StampOf stamp_of;
  for (std::size_t i = 0; i < frames.stamps_s.size(); ++i)
    stamp_of[core::FrameId(i)] = frames.stamps_s[i];
  try {
    add_loops(ledger, stamp_of, findings);
    add_relocalized(ledger, stamp_of, frames.relocalized, findings);
  } catch (const std::out_of_range&) {
    throw core::InputError((folder / "loops.json").string() +
                           ": a loop names a frame that frames.csv does not have");
  }
  return findings;
}

}  // namespace

std::filesystem::path run_folder_of(const std::filesystem::path& path) {
  std::error_code unknown;  // what cannot be looked at is told by the one that opens it
  if (path.extension() != ".sw" || std::filesystem::is_directory(path, unknown)) return path;
  return path.has_parent_path() ? path.parent_path() : ".";
}

std::filesystem::path map_file_of(const std::filesystem::path& path) {
  std::error_code unknown;
  return std::filesystem::is_directory(path, unknown) ? path / "map.sw" : path;
}

pipeline::Config config_of_run(const std::filesystem::path& folder,
                               const std::vector<std::string>& assignments) {
  pipeline::Config config;
  const std::filesystem::path config_file = folder / "config.yaml";
  core::read_config(config, core::read_file(config_file, core::kSettingsLimit),
                    config_file.string());
  for (const auto& assignment : assignments) core::set_config(config, assignment);
  return config;
}

core::Ledger ledger_of_run(const std::filesystem::path& folder) { return ledger_in_step(folder); }

const core::LedgerRow& row_of(const core::Ledger& ledger, std::size_t candidate,
                              const std::filesystem::path& folder) {
  if (candidate < ledger.size()) return ledger[candidate];
  throw core::InputError(
      ledger.empty()
          ? fmt::format("{}: there is no candidate {}, nor any other", folder.string(), candidate)
          : fmt::format("{}: there is no candidate {}; expected 0 to {}", folder.string(),
                        candidate, ledger.size() - 1));
}

namespace {

const features::View& view_of(const scene::MapVersion& map, core::FrameId frame,
                              const std::filesystem::path& map_path) {
  if (const scene::Keyframe* keyframe = keyframe_of(map, frame)) return keyframe->view;
  throw core::InputError(
      fmt::format("{}: frame {} is no keyframe of it", map_path.string(), frame.index()));
}

std::string picture_of(scene::MapFile& file, core::FrameId frame,
                       const std::filesystem::path& map_path) {
  if (auto jpeg = file.thumbnail(frame)) return *std::move(jpeg);
  throw core::InputError(
      fmt::format("{}: has no thumbnail of frame {}", map_path.string(), frame.index()));
}

}  // namespace

report::PairRecord pair_of_run(const std::filesystem::path& folder, const core::LedgerRow& row) {
  const std::filesystem::path path = folder / "map.sw";
  if (row.candidate.origin == core::Origin::kRelocalization)
    throw core::InputError(
        fmt::format("{}: candidate {} is a relocalization candidate of frame {}, which has no "
                    "thumbnail; expected a "
                    "loop candidate between keyframes",
                    folder.string(), row.candidate.id.index(), row.candidate.query.index()));
  scene::MapFile file = scene::MapFile::open(path);
  const scene::MapVersion map = file.load().map;
  const features::View& query = view_of(map, row.candidate.query, path);
  const features::View& match = view_of(map, row.candidate.match, path);
  report::PairRecord pair{row,
                          {picture_of(file, query.frame, path), query.image_size_px},
                          {picture_of(file, match.frame, path), match.image_size_px},
                          {}};
  const features::Config config = config_of_run(folder).features;
  // in this order, as the verifier does: the ratio test depends on it
  for (const auto& found :
       features::match_pair(match.features->descriptors, query.features->descriptors, config)) {
    pair.matches_px.emplace_back(query.features->raw_px[static_cast<std::size_t>(found.second)],
                                 match.features->raw_px[static_cast<std::size_t>(found.first)]);
  }
  return pair;
}

namespace {

// What comes with the source, with the trajectory of the file in place of its own.
core::Truth with_trajectory(core::Truth truth, const std::filesystem::path& file,
                            const core::Trajectory& estimate) {
  truth.trajectory = core::read_tum(file);
  truth.inertial.clear();
  const auto is_covered = [&](const core::StampedPose& pose) {
    return evaluate::truth_at(truth.trajectory, pose.stamp_s).has_value();
  };
  if (!estimate.empty() && std::none_of(estimate.begin(), estimate.end(), is_covered)) {
    throw core::InputError(
        fmt::format("{}: has no pose at a time of the run, {:.3f} to {:.3f} s; expected "
                    "stamps of the same clock",
                    file.string(), estimate.front().stamp_s, estimate.back().stamp_s));
  }
  return truth;
}

}  // namespace

std::vector<report::Figure> evaluate_folder(const std::filesystem::path& folder,
                                            const std::filesystem::path& truth_file) {
  pipeline::Config config = config_of_run(folder);
  const bool is_recognition = core::is_there(folder / "matches.txt");
  config.input.needs_calibration = !is_recognition;
  const auto source = open_source(config);
  core::Truth truth = source->truth();
  if (is_recognition) {
    const RecognitionFindings findings{
        static_cast<int>(ledger_of_run(folder).size()), read_pairs(folder / "matches.txt"),
        read_pairs(folder / "accepted.txt"), config.retrieve.window_frames};
    return figures_of(evaluate_recognition(findings, truth));
  }
  const SlamFindings findings =
      read_slam_findings(folder, is_scale_free(source->info()) && !config.odometry.is_used());
  if (!truth_file.empty())
    truth = with_trajectory(std::move(truth), truth_file, findings.trajectory);
  return figures_of(evaluate_slam(findings, truth));
}

std::vector<report::Figure> evaluate_walk(const std::filesystem::path& folder,
                                          const std::filesystem::path& walk) {
  std::vector<evaluate::Match> accepted;
  for (const auto& pair : read_pairs(folder / "accepted.txt")) {
    accepted.push_back(
        {static_cast<int>(pair.query.index()), static_cast<int>(pair.match.index()), pair.score});
  }
  const evaluate::WalkCounts counts = count_walk(evaluate::read_walk(walk), accepted);
  return {report::figure("loops accepted", "{}", counts.num_loops),
          report::figure("false loops between two floors", "{}", counts.num_false),
          report::figure("loops on one floor, in one clip", "{}, {}", counts.num_same_floor,
                         counts.num_same_clip)};
}

report::Table stages_of_folder(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / "timing.json";
  return report::stage_table(core::read_file(path, core::kTimingLimit), path.string());
}

}  // namespace samewhere::run
