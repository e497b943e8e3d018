#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <samewhere/paper/rows.hpp>

namespace samewhere::paper {

// A row that could not be measured, and why.
struct MissingRow {
  std::string recording;  // empty: on none
  std::string method;     // or configuration of SLAM
  std::string reason;
};

// A method or configuration under the name that the tables give it.
struct ComparedMethod {
  std::string name;
  std::string title;
  std::string what_ran;
};

// All that a benchmark has measured so far.
struct Results {
  std::vector<std::string> recordings;         // in the order of the tables
  std::vector<ComparedMethod> methods;         // the same
  std::vector<ComparedMethod> configurations;  // of SLAM
  std::vector<RecognitionRow> recognition;
  std::vector<SlamRow> slam;
  std::vector<MissingRow> missing;
};

// results.json: what the Python package draws.
nlohmann::json results_json(const Results& results);
// One row for each recognition row and for each SLAM row. As CSV.
std::string recognition_csv(const Results& results);
std::string slam_csv(const Results& results);

}  // namespace samewhere::paper
