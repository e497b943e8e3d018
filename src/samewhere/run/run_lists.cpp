#include <algorithm>
#include <iterator>
#include <optional>
#include <tuple>

#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/pipeline/slam.hpp>
#include <samewhere/report/frames.hpp>
#include <samewhere/report/loops.hpp>
#include <samewhere/report/loops_read.hpp>
#include <samewhere/report/ply.hpp>
#include <samewhere/run/map_export.hpp>
#include <samewhere/run/run_lists.hpp>

namespace samewhere::run {
namespace {

// What only a verdict by hand has, as JSON. Others may have it by chance: then more is compared.
bool may_be_by_hand(const std::string& row) {
  return row.find("by hand") != std::string::npos || row.find("is_by_hand") != std::string::npos;
}

// From the first verdict by hand on. What came before it the run itself wrote into loops.json; a
// map that was not saved to its end lacks some of that.
std::vector<std::string> rows_since_by_hand(const std::filesystem::path& map) {
  std::vector<std::string> rows = scene::MapFile::open(map).ledger();
  rows.erase(rows.begin(), std::find_if(rows.begin(), rows.end(), may_be_by_hand));
  return rows;
}

// A row of the map does not say which number its candidate has. nullptr: none is like that, or
// several are.
core::LedgerRow* find(core::Ledger& ledger, const core::Candidate& wanted) {
  const auto key = [](const core::Candidate& c) {
    return std::tuple(c.query, c.match, c.is_foretold, c.is_lost, c.is_by_features);
  };
  core::LedgerRow* found = nullptr;
  for (core::LedgerRow& row : ledger) {
    if (key(row.candidate) != key(wanted)) continue;
    if (found != nullptr) return nullptr;
    found = &row;
  }
  return found;
}

struct NumberedAs {
  core::CandidateId id;
  template <class Verdict>
  void operator()(Verdict& verdict) const {
    verdict.candidate = id;
  }
};

core::Ledger with_last_verdicts(core::Ledger ledger, const core::Ledger& later) {
  for (const core::LedgerRow& row : later) {
    core::LedgerRow* known = find(ledger, row.candidate);
    if (known == nullptr) continue;  // of another session, say
    known->verdict = row.verdict;
    std::visit(NumberedAs{known->candidate.id}, known->verdict);
  }
  return ledger;
}

bool holds_one_run(const scene::MapVersion& map) {
  return !map.keyframes.empty() && map.keyframes.back().view.frame.session() == 0;
}

void write_anew(const std::filesystem::path& folder, const core::Ledger& ledger,
                const core::FolderLock* held) {
  std::optional<core::FolderLock> lock;
  if (held == nullptr) lock.emplace(folder);
  // no other program changes the map or the lists meanwhile
  scene::MapFile file = scene::MapFile::open(folder / "map.sw", scene::MapAccess::kExtend);
  const scene::StoredMap stored = file.load();
  if (!holds_one_run(stored.map)) return;
  write_lists(lists_of(stored, ledger, core::read_file(folder / "frames.csv")), folder);
  spdlog::warn(
      "{}: its lists were older than its map, since a change by hand was cut short; they were "
      "written anew from the map",
      folder.string());
}

}  // namespace

RunLists lists_of(const scene::StoredMap& stored, const core::Ledger& ledger,
                  const std::string& frames_csv) {
  const core::Trajectory trajectory = pipeline::trajectory_of(stored.map, stored.extras.frames);
  return {{"trajectory.tum", core::tum_text(trajectory)},
          {"odometry.tum", core::tum_text(pipeline::odometry_of(stored.map, stored.extras.frames))},
          {"frames.csv", report::with_poses(frames_csv, trajectory)},
          {"map.ply", report::ply_bytes(points_of(stored.map))},
          {"loops.json", report::loops_json(ledger)}};
}

void write_lists(const RunLists& lists, const std::filesystem::path& folder) {
  core::FilesTogether files;
  for (const auto& [name, text] : lists) {
    core::remove_partial_files(folder / name);
    files.add(folder / name, text);
  }
  files.publish();
}

core::Ledger ledger_in_step(const std::filesystem::path& folder, const core::FolderLock* held) {
  core::Ledger ledger = report::read_loops_json(folder / "loops.json");
  const std::filesystem::path map = folder / "map.sw";
  if (!std::filesystem::exists(map)) return ledger;
  try {
    const core::Ledger later = report::read_ledger_rows(rows_since_by_hand(map), map.string());
    core::Ledger of_map = with_last_verdicts(ledger, later);
    if (report::loops_json(of_map) == report::loops_json(ledger)) return ledger;
    write_anew(folder, of_map, held);
    return of_map;
  } catch (const core::InputError& error) {
    spdlog::warn("{}; whether the lists of {} go with its map is not known", error.what(),
                 folder.string());
  }
  return ledger;
}

}  // namespace samewhere::run
