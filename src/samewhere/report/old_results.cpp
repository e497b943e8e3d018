#include <string>
#include <string_view>
#include <system_error>

#include <samewhere/core/errors.hpp>
#include <samewhere/report/old_results.hpp>

namespace samewhere::report {
namespace {

constexpr const char* kOfRun = "config.yaml";  // written first, and by every run
constexpr const char* kResults[] = {"trajectory.tum", "odometry.tum", "frames.csv", "map.ply",
                                    "matches.txt",    "accepted.txt", "loops.json", "timing.json",
                                    "report.html",    "map.sw",       "map.sw-wal", "map.sw-shm",
                                    "cloud.ply",      "map.pgm",      "map.yaml",   "map.bt"};

}  // namespace

void require_folder_for_results(const std::filesystem::path& folder,
                                const std::filesystem::path& source) {
  std::error_code not_there;
  if (std::filesystem::equivalent(folder, source, not_there)) {
    throw core::InputError(folder.string() +
                           ": is the recording itself; expected another folder for the results");
  }
  if (std::filesystem::exists(folder / kOfRun)) return;
  for (const char* name : kResults) {
    if (!std::filesystem::exists(folder / name)) continue;
    throw core::InputError((folder / name).string() +
                           ": is there already and of no earlier run (no " + kOfRun +
                           " beside it); expected another folder for the results");
  }
}

void remove_old_results(const std::filesystem::path& folder,
                        const std::filesystem::path& known_map) {
  std::error_code no_map;
  const bool is_map_here = std::filesystem::equivalent(folder / "map.sw", known_map, no_map);
  for (const char* name : kResults) {
    if (is_map_here && std::string_view(name).starts_with("map.sw")) continue;
    std::error_code ignored;  // a file that stays will be written over, or fail loudly then
    std::filesystem::remove(folder / name, ignored);
  }
}

}  // namespace samewhere::report
