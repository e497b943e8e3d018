#pragma once

#include <string>
#include <vector>

#include <samewhere/report/record.hpp>

namespace samewhere::report {

// report.html: one self-contained page that needs no network, in light and dark, for phones and
// paper too. Landmarks, trajectory and loop candidates in 3D, plots over time, the pictures of
// candidates with their feature matches, every score beside its threshold, the verification funnel,
// metrics and the configuration. The same record gives the same bytes. Durations are in the last
// line alone, so that two runs of the same input differ in nothing else (without_durations).
std::string report_html(const RunRecord& record);

// The data blocks of the page (page/README.md), as JSON.
struct PageBlocks {
  std::string title;  // plain text
  std::string run = "null";
  std::string pictures = "[]";
  std::string durations = "null";
};
PageBlocks page_blocks(const RunRecord& record);

// The page as a viewer serves it: it may ask the server that it came from, for what the block
// `live` says.
std::string served_html(const PageBlocks& blocks, const std::string& live_json);

// The page with a dense point cloud beside the landmarks, in place of an earlier one. Throws
// InputError if the text is no report page.
std::string with_dense_cloud(const std::string& report_html,
                             const std::vector<ColouredPoint>& cloud);

// The page up to its last block, which holds the durations.
std::string without_durations(const std::string& report_html);

}  // namespace samewhere::report
