#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <samewhere/core/folder_lock.hpp>
#include <samewhere/core/ledger.hpp>
#include <samewhere/scene/map_file.hpp>

namespace samewhere::run {

// The files of a run's folder that say of its map what other programs read: trajectory.tum,
// odometry.tum, frames.csv, map.ply and, last of them, loops.json.
struct RunList {
  const char* file = nullptr;
  std::string text;
};
using RunLists = std::vector<RunList>;

// `frames_csv`: the file as it is; its poses are replaced. Throws InputError if it does not go with
// the map.
RunLists lists_of(const scene::StoredMap& stored, const core::Ledger& ledger,
                  const std::string& frames_csv);

// Each whole or not at all, all at once and in their order: where loops.json goes with the map, all
// do. The caller holds the folder's lock.
void write_lists(const RunLists& lists, const std::filesystem::path& folder);

// The ledger of a finished run. A change by hand commits its map first and writes the lists then:
// if it was cut short between the two, the lists are written anew from the map, and a warning says
// so. Throws InputError as report::read_loops_json does. A folder that cannot be written or that
// another program is writing into, or a map that cannot be read, keeps its lists. `held`: the lock
// of the folder, where the caller has it.
core::Ledger ledger_in_step(const std::filesystem::path& folder,
                            const core::FolderLock* held = nullptr);

}  // namespace samewhere::run
