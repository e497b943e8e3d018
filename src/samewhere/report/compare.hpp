#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <samewhere/report/record.hpp>
#include <samewhere/report/table.hpp>

namespace samewhere::report {

// The last verdict on a candidate, as a report page holds it.
struct JudgedPair {
  int query = 0;  // frame indices
  int match = 0;
  std::string verdict;    // "accepted", "ambiguous: evidence", "rejected: odometry"
  bool is_false = false;  // accepted, and the ground truth contradicts it
};

// A finished run as its report page tells it.
struct ComparedRun {
  std::string name;
  std::string source;
  std::vector<Figure> figures;         // without their numbers
  std::vector<JudgedPair> candidates;  // in the order of the queries
  std::string run_json;                // the blocks of the page (page/README.md)
  std::string pictures_json;
  std::string durations_json;
};

// Reads the text of a report.html. Throws InputError naming `origin` if it is none of this version.
ComparedRun read_report_html(std::string_view html, std::string name, const std::string& origin);

// What the verifier of one run said of the false loops that another run accepted.
struct JudgedElsewhere {
  std::size_t accepted_by = 0;  // positions in the runs
  std::size_t judged_by = 0;
  std::vector<std::pair<std::string, int>> verdicts;  // with how many, most first
};

// For each run with false loops and each other run of the same source. A candidate is the same one
// if both its views are at most 10 frames away; "no candidate": there is none.
std::vector<JudgedElsewhere> judged_elsewhere(const std::vector<ComparedRun>& runs);

// Metrics, a column per run.
Table metrics_of(const std::vector<ComparedRun>& runs);

// One self-contained page with the maps of the runs beside each other, one camera for all: paths
// beside the ground truth, accepted loops and false ones, metrics, what the verifier of one run
// said of the false loops of another, and the settings in which they differ.
std::string compare_html(const std::vector<ComparedRun>& runs);

}  // namespace samewhere::report
