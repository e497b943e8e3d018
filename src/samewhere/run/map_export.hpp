#pragma once

#include <filesystem>
#include <vector>

#include <samewhere/report/record.hpp>
#include <samewhere/scene/map_file.hpp>

namespace samewhere::run {

// The landmarks that the map shows today.
std::vector<report::ColouredPoint> points_of(const scene::MapVersion& map);

// What is in a map file, for a person: its parts by number, then the settings it hangs on.
std::vector<report::Figure> figures_of_map(const scene::MapHeader& header,
                                           const scene::StoredMap& stored);

// The session whose frames are wanted: `wanted`, or where that is -1 the only one. Throws
// InputError if there is no such session, or several and none was named.
int session_of(const scene::StoredMap& stored, int wanted);

// Files to be written from a map; empty: not wanted.
struct MapExports {
  std::filesystem::path ply;    // landmarks, metres, with colour
  std::filesystem::path tum;    // measured frames, camera 0, with stamps
  std::filesystem::path kitti;  // the same frames, without
  std::filesystem::path g2o;    // keyframes, odometry and loops
  int session = -1;             // of these frames; -1: the only one
};

// Each whole or not at all. Throws InputError if none is wanted, two are one file, one cannot be
// written, or if frames are wanted and session_of() throws.
void export_map(const scene::StoredMap& stored, const MapExports& wanted);

}  // namespace samewhere::run
