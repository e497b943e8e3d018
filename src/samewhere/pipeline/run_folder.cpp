#include <algorithm>
#include <map>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/evaluate/tower_walk.hpp>
#include <samewhere/pipeline/figures.hpp>
#include <samewhere/pipeline/open_source.hpp>
#include <samewhere/pipeline/run_folder.hpp>
#include <samewhere/report/timing_json.hpp>

namespace samewhere::pipeline {
namespace {

using Json = nlohmann::json;

Json read_loops(const std::filesystem::path& path) {
  const Json loops = Json::parse(core::read_file(path), nullptr, false);
  if (loops.is_discarded() || !loops.contains("candidates") || !loops["candidates"].is_array()) {
    throw core::InputError(path.string() +
                           ": not a loops.json; expected {\"version\": 1, \"candidates\": [...]}");
  }
  return loops["candidates"];
}

// Stamps of all frames, by position: the second column of frames.csv.
std::vector<double> read_stamps(const std::filesystem::path& path) {
  std::istringstream lines(core::read_file(path));
  std::string line;
  std::getline(lines, line);  // names of the columns
  std::vector<double> stamps_s;
  while (std::getline(lines, line)) {
    const auto first = line.find(',');
    try {
      stamps_s.push_back(std::stod(line.substr(first + 1)));
    } catch (const std::exception&) {
      throw core::InputError(
          fmt::format("{}, line {}: expected index,stamp,...", path.string(), stamps_s.size() + 2));
    }
  }
  return stamps_s;
}

std::optional<core::Rigid3> read_pose(const Json& pose) {
  if (pose.is_null()) return std::nullopt;
  const auto v = pose.get<std::array<double, 7>>();
  return core::Rigid3{Eigen::Quaterniond(v[6], v[3], v[4], v[5]), {v[0], v[1], v[2]}};
}

std::vector<evaluate::AcceptedLoop> accepted_loops(const Json& candidates,
                                                   const std::vector<double>& stamps_s) {
  std::vector<evaluate::AcceptedLoop> loops;
  for (const auto& candidate : candidates) {
    if (candidate.at("verdict") != "LOOP") continue;
    evaluate::AcceptedLoop loop;
    loop.query = candidate.at("query").get<int>();
    loop.match = candidate.at("match").get<int>();
    loop.query_stamp_s = stamps_s.at(static_cast<std::size_t>(loop.query));
    loop.match_stamp_s = stamps_s.at(static_cast<std::size_t>(loop.match));
    loop.match_from_query = read_pose(candidate.at("match_from_query"));
    loops.push_back(loop);
  }
  return loops;
}

int count_stage(const Json& candidates, core::Refusal stage) {
  return static_cast<int>(std::count_if(
      candidates.begin(), candidates.end(),
      [&](const Json& candidate) { return candidate.value("stage", "") == core::name_of(stage); }));
}

std::vector<report::ScoredPair> read_pairs(const std::filesystem::path& path) {
  std::istringstream lines(core::read_file(path));
  std::vector<report::ScoredPair> pairs;
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line);
    std::uint64_t query = 0;
    std::uint64_t match = 0;
    double score = 0.0;
    if (!(words >> query >> match >> score)) {
      throw core::InputError(
          fmt::format("{}, line {}: expected `query match score`", path.string(), number));
    }
    pairs.push_back({core::FrameId(query), core::FrameId(match), score});
  }
  return pairs;
}

SlamFindings read_slam_findings(const std::filesystem::path& folder, bool is_scale_free) {
  const std::vector<double> stamps_s = read_stamps(folder / "frames.csv");
  const Json candidates = read_loops(folder / "loops.json");
  try {
    return {static_cast<int>(stamps_s.size()),
            core::read_tum(folder / "trajectory.tum"),
            core::read_tum(folder / "odometry.tum"),
            static_cast<int>(candidates.size()),
            accepted_loops(candidates, stamps_s),
            is_scale_free,
            {},
            count_stage(candidates, core::Refusal::kGraph),
            count_stage(candidates, core::Refusal::kWithdrawn)};
  } catch (const Json::exception& error) {
    throw core::InputError(fmt::format("{}: a candidate is not as expected: {}",
                                       (folder / "loops.json").string(), error.what()));
  } catch (const std::out_of_range&) {
    throw core::InputError((folder / "loops.json").string() +
                           ": a loop names a frame that frames.csv does not have");
  }
}

}  // namespace

Config config_of_run(const std::filesystem::path& folder) {
  Config config;
  const std::filesystem::path config_file = folder / "config.yaml";
  core::read_config(config, core::read_file(config_file), config_file.string());
  return config;
}

std::vector<report::Figure> evaluate_folder(const std::filesystem::path& folder) {
  const Config config = config_of_run(folder);
  const auto source = open_source(config);
  const core::Truth truth = source->truth();
  if (std::filesystem::exists(folder / "matches.txt")) {
    const RecognitionFindings findings{static_cast<int>(read_loops(folder / "loops.json").size()),
                                       read_pairs(folder / "matches.txt"),
                                       read_pairs(folder / "accepted.txt"),
                                       config.retrieve.window_frames};
    return figures_of(evaluate_recognition(findings, truth));
  }
  return figures_of(
      evaluate_slam(read_slam_findings(folder, is_scale_free(source->info())), truth));
}

std::vector<report::Figure> evaluate_walk(const std::filesystem::path& folder,
                                          const std::filesystem::path& walk) {
  std::vector<evaluate::Match> accepted;
  for (const auto& pair : read_pairs(folder / "accepted.txt")) {
    accepted.push_back(
        {static_cast<int>(pair.query.index()), static_cast<int>(pair.match.index()), pair.score});
  }
  const evaluate::WalkCounts counts = count_walk(evaluate::read_walk(walk), accepted);
  return {{"loops accepted", std::to_string(counts.num_loops)},
          {"of these between two floors (wrong)", std::to_string(counts.num_wrong)},
          {"on one floor, of these in one clip",
           fmt::format("{}, {}", counts.num_same_floor, counts.num_same_clip)}};
}

report::Table stages_of_folder(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / "timing.json";
  return report::stage_table(core::read_file(path), path.string());
}

}  // namespace samewhere::pipeline
