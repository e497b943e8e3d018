#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/report/results_folder.hpp>
#include <samewhere/scene/writer_lock.hpp>

namespace samewhere::report {
namespace {

namespace fs = std::filesystem;
using core::InputError;

constexpr const char* kOfRun = "config.yaml";      // written first, and by every run
constexpr std::string_view kFirstKey = "source:";  // of a run's config.yaml
constexpr const char* kResults[] = {
    kOfRun,         "trajectory.tum", "odometry.tum", "frames.csv",  "map.ply", "matches.txt",
    "accepted.txt", "loops.json",     "timing.json",  "report.html", "map.sw",  "map.sw-wal",
    "map.sw-shm",   "cloud.ply",      "map.pgm",      "map.yaml",    "map.bt"};

// A link has the name, wherever it leads; what may not be looked at fails loudly when it is
// written.
bool is_name_taken(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(path, ignored));
}

bool is_of_run(const fs::path& folder) {
  const fs::path config = folder / kOfRun;
  return is_name_taken(config) &&
         core::read_file(config, core::kSettingsLimit).starts_with(kFirstKey);
}

}  // namespace

ResultsFolder::ResultsFolder(ResultsPlace place) : place_(std::move(place)) {
  const fs::path& folder = place_.folder;
  if (folder.empty() || !core::is_there(folder)) return;
  if (!core::is_folder(folder))
    throw InputError(folder.string() + ": is no folder; expected a folder for the results");
  std::error_code not_there;
  if (fs::equivalent(folder, place_.source, not_there)) {
    throw InputError(folder.string() +
                     ": is the recording itself; expected another folder for the results");
  }
  lock_.emplace(folder);
  require_usable();
}

void ResultsFolder::require_usable() const {
  const fs::path& folder = place_.folder;
  if (is_of_run(folder)) {
    if (place_.replaces_earlier) return;
    throw InputError(folder.string() +
                     ": holds the results of an earlier run; expected another folder, or --force "
                     "to replace them");
  }
  for (const char* name : kResults) {
    if (!is_name_taken(folder / name)) continue;
    throw InputError((folder / name).string() + ": is there already and of no earlier run (no " +
                     kOfRun + " beside it); expected another folder for the results");
  }
}

void ResultsFolder::begin() {
  if (place_.folder.empty()) {
    make_of_name();
  } else {
    core::make_writable_folder(place_.folder);
    if (!lock_) lock_.emplace(place_.folder);
    require_usable();  // another run may have ended there meanwhile
    remove_earlier_results();
  }
  has_begun_ = true;
}

void ResultsFolder::make_of_name() {
  fs::path folder = place_.name;
  for (int number = 2; !core::make_new_folder(folder); ++number)
    folder = fmt::format("{}-{}", place_.name.string(), number);
  place_.folder = folder;
  lock_.emplace(folder);
}

void ResultsFolder::remove_earlier_results() const {
  const fs::path& folder = place_.folder;
  std::error_code ignored;
  const fs::path map = folder / "map.sw";
  const bool is_map_here = fs::equivalent(map, place_.known_map, ignored);
  // no other program may be writing to what goes
  std::optional<scene::WriterLock> lock;
  if (!is_map_here && fs::is_regular_file(fs::symlink_status(map, ignored)))
    lock.emplace(map, scene::WriterLock::File::kIsThere);
  int num_removed = 0;
  for (const char* name : kResults) {
    core::remove_partial_files(folder / name);
    if (is_map_here && std::string_view(name).starts_with("map.sw")) continue;
    // a file that stays will be written over, or fail loudly then
    if (fs::remove(folder / name, ignored)) ++num_removed;
  }
  if (num_removed > 0)
    spdlog::info("{}: removed {} files of an earlier run", folder.string(), num_removed);
}

}  // namespace samewhere::report
