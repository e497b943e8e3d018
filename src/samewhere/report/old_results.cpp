#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/report/old_results.hpp>
#include <samewhere/scene/writer_lock.hpp>

namespace samewhere::report {
namespace {

constexpr const char* kOfRun = "config.yaml";      // written first, and by every run
constexpr std::string_view kFirstKey = "source:";  // of a run's config.yaml
constexpr const char* kResults[] = {
    kOfRun,         "trajectory.tum", "odometry.tum", "frames.csv",  "map.ply", "matches.txt",
    "accepted.txt", "loops.json",     "timing.json",  "report.html", "map.sw",  "map.sw-wal",
    "map.sw-shm",   "cloud.ply",      "map.pgm",      "map.yaml",    "map.bt"};

bool is_there(const std::filesystem::path& path) {
  std::error_code ignored;  // what may not be looked at will fail loudly when it is written
  return std::filesystem::exists(path, ignored);
}

bool is_of_run(const std::filesystem::path& folder) {
  return is_there(folder / kOfRun) && core::read_file(folder / kOfRun).starts_with(kFirstKey);
}

}  // namespace

void require_folder_for_results(const std::filesystem::path& folder,
                                const std::filesystem::path& source) {
  std::error_code not_there;
  if (std::filesystem::equivalent(folder, source, not_there)) {
    throw core::InputError(folder.string() +
                           ": is the recording itself; expected another folder for the results");
  }
  if (is_of_run(folder)) return;
  for (const char* name : kResults) {
    if (!is_there(folder / name)) continue;
    throw core::InputError((folder / name).string() +
                           ": is there already and of no earlier run (no " + kOfRun +
                           " of one beside it); expected another folder for the results");
  }
}

void remove_old_results(const std::filesystem::path& folder,
                        const std::filesystem::path& known_map) {
  std::error_code no_map;
  const std::filesystem::path map = folder / "map.sw";
  const bool is_map_here = std::filesystem::equivalent(map, known_map, no_map);
  // nobody may be writing to what goes
  std::optional<scene::WriterLock> lock;
  if (!is_map_here && is_there(map)) lock.emplace(map, scene::WriterLock::File::kIsThere);
  for (const char* name : kResults) {
    if (is_map_here && std::string_view(name).starts_with("map.sw")) continue;
    std::error_code ignored;  // a file that stays will be written over, or fail loudly then
    std::filesystem::remove(folder / name, ignored);
  }
}

}  // namespace samewhere::report
