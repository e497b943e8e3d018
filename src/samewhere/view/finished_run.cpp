#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/pipeline/slam.hpp>
#include <samewhere/report/compare.hpp>
#include <samewhere/report/loops_read.hpp>
#include <samewhere/report/page_parts.hpp>
#include <samewhere/report/page_points.hpp>
#include <samewhere/report/pairs.hpp>
#include <samewhere/run/map_export.hpp>
#include <samewhere/run/run_folder.hpp>
#include <samewhere/scene/map_file.hpp>
#include <samewhere/view/finished_run.hpp>

namespace samewhere::view {
namespace {

using Json = nlohmann::ordered_json;

bool is_same_verdict(const Json& a, const Json& b) {
  return a["verdict"] == b["verdict"] && a["stage"] == b["stage"] && a["reason"] == b["reason"];
}

// The candidates of the page with the last verdicts of the ledger. Whether any has changed.
bool take_verdicts(Json& candidates, const core::Ledger& ledger) {
  bool has_changed = false;
  for (Json& entry : candidates) {
    const auto id = entry.at("id").get<std::size_t>();
    if (id >= ledger.size()) continue;
    Json now = report::page_candidate(ledger[id]);
    if (is_same_verdict(entry, now)) continue;
    has_changed = true;
    Json earlier = entry.value("earlier", Json::array());
    earlier.push_back(
        {{"verdict", entry["verdict"]}, {"stage", entry["stage"]}, {"reason", entry["reason"]}});
    now["earlier"] = std::move(earlier);
    if (entry.contains("matches")) now["matches"] = entry["matches"];
    if (entry.contains("is_false") && now["verdict"] == "LOOP") now["is_false"] = true;
    entry = std::move(now);
  }
  return has_changed;
}

std::vector<report::FrameRecord> records_of(const scene::StoredMap& stored, const Json& names) {
  std::vector<report::FrameRecord> records;
  for (const core::FramePose& pose : stored.extras.frames) {
    const std::size_t i = records.size();
    report::FrameRecord record{pose, i < names.size() ? names[i].get<std::string>() : "",
                               std::nullopt};
    if (pose.is_measured) record.world_from_camera = pipeline::world_from_camera(stored.map, pose);
    records.push_back(std::move(record));
  }
  return records;
}

// Poses and landmarks after the change.
void take_map(Json& run, const std::filesystem::path& map) {
  const scene::StoredMap stored = scene::MapFile::open(map).load();
  Json& frames = run["frames"];
  if (stored.extras.frames.size() == frames.at("num").get<std::size_t>()) {
    const report::PageClock clock(frames.at("first_stamp_s").get<double>());
    frames = report::page_frames(records_of(stored, frames.at("names")), clock);
  }
  constexpr std::size_t kMaxPoints = 400'000;
  run["points"] = report::page_points(run::points_of(stored.map), kMaxPoints);
  run["covariances"] = nullptr;  // were those of the loops before
}

void take_metrics(Json& run, const std::filesystem::path& folder) {
  try {
    Json metrics = Json::array();
    for (const report::Figure& figure : run::evaluate_folder(folder))
      metrics.push_back({{"name", figure.name}, {"value", figure.value}});
    run["figures"] = std::move(metrics);
  } catch (const core::InputError& error) {
    run["figures"].push_back(
        {{"name", "metrics"},
         {"value", std::string("from before the change by hand: ") + error.what()}});
  }
}

}  // namespace

bool may_override(const std::filesystem::path& folder) {
  return core::is_there(folder / "map.sw") && core::is_there(folder / "frames.csv");
}

report::PageBlocks page_of_run(const std::filesystem::path& folder) {
  const std::filesystem::path page = folder / "report.html";
  report::ComparedRun stored = report::read_report_html(core::read_file(page), "", page.string());
  report::PageBlocks blocks{"", std::move(stored.run_json), std::move(stored.pictures_json),
                            std::move(stored.durations_json)};
  const core::Ledger ledger = run::ledger_of_run(folder);
  try {
    Json run = Json::parse(blocks.run);
    blocks.title = run.at("title").get<std::string>();
    if (!take_verdicts(run.at("candidates"), ledger)) return blocks;
    run["checks"] = report::page_checks(ledger);
    if (may_override(folder)) take_map(run, folder / "map.sw");
    take_metrics(run, folder);
    blocks.run = report::json_for_script(run);
  } catch (const nlohmann::json::exception&) {
    throw core::InputError(page.string() +
                           ": its data is damaged; expected a page of `samewhere run`");
  }
  return blocks;
}

report::PageBlocks page_of_map(const std::filesystem::path& path) {
  scene::MapFile file = scene::MapFile::open(path);
  const scene::StoredMap stored = file.load();
  report::RunRecord record;
  record.title = path.filename().string();
  record.source = path.string();
  for (std::size_t i = 0; i < stored.map.keyframes.size(); ++i) {
    const scene::Keyframe& keyframe = stored.map.keyframes[i];
    if (!is_live(keyframe)) continue;
    const core::FramePose pose{.frame = keyframe.view.frame,
                               .stamp_s = keyframe.view.stamp_s,
                               .status = core::FrameStatus::kTracking,
                               .is_measured = true,
                               .reference_keyframe = keyframe.id};
    record.frames.push_back({pose, "", pipeline::world_from_camera(stored.map, pose)});
    if (const auto jpeg = file.thumbnail(pose.frame)) record.thumbnails[pose.frame] = *jpeg;
  }
  if (record.frames.empty())
    throw core::InputError(path.string() + ": is a map without a keyframe");
  record.points = run::points_of(stored.map);
  record.ledger = report::read_ledger_rows(stored.extras.ledger, path.string());
  record.figures = run::figures_of_map(file.header(), stored);
  record.is_scale_unknown = scene::is_without_depth(stored.map);
  return report::page_blocks(record);
}

}  // namespace samewhere::view
