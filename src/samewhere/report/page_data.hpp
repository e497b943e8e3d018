#pragma once

#include <cstddef>
#include <string>

#include <samewhere/report/record.hpp>

namespace samewhere::report {

inline constexpr int kPageVersion = 1;  // of the objects in page/README.md

// How much the report page holds, for it to open at once whatever the length of the run. The page
// states what was left out.
inline constexpr std::size_t kMaxPagePoints = 400'000;
inline constexpr std::size_t kMaxPageCandidates = 8'000;
inline constexpr std::size_t kMaxPagePictures_bytes = 9'000'000;

// The data blocks of the report page as JSON; page/README.md describes their objects. `<` stands in
// them as \u003c, so that they can stand in a script element. Values that are not finite are left
// out.
std::string page_run_json(const RunRecord& record);
std::string page_pictures_json(const RunRecord& record);
std::string page_durations_json(const RunRecord& record);

}  // namespace samewhere::report
