#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <samewhere/core/timing.hpp>
#include <samewhere/evaluate/precision_recall.hpp>

namespace samewhere::paper {

// The search behind a recognition row.
enum class SearchKind {
  kSampled,     // the published one, with a number of draws and a seed
  kEveryQueue,  // what it tends to with more draws
  kExact,       // all earlier images
  kOwn          // the method's own
};

// "sampled", "every queue", "exact", "own".
std::string name_of(SearchKind search);

// Loops that a method accepts, by the place truth.
struct RecognitionLoops {
  int num_true = 0;
  int num_false = 0;
  int num_near = 0;                // not counted
  std::optional<int> num_aliased;  // of the false ones; only if the truth names any
};

// One method on one sequence, once: Tables 2 to 5.
struct RecognitionRow {
  std::string recording;
  int window_frames = 0;
  std::string method;  // as --methods has it
  SearchKind search = SearchKind::kOwn;
  int num_draws = 0;  // of a sampled search
  int seed = 0;
  evaluate::PrecisionRecall result;
  RecognitionLoops loops;
  // Milliseconds a frame on one core, without reading the image: by step, and of all as kTogether.
  std::map<std::string, core::TimingSummary> ms;
};

inline constexpr const char* kTogether = "together";

// A point of a path seen from above or from where it extends most: of the estimate, and of the
// truth at the same moment, both in the truth's world, metres.
struct PathPoint {
  std::array<double, 3> estimate{};
  std::array<double, 3> truth{};
};

// An accepted loop, by the truth: where its query and its match are.
struct PathLoop {
  std::array<double, 3> query{};
  std::array<double, 3> match{};
  bool is_false = false;
};

// Absolute trajectory error, eq. (24)-(25), metres.
struct SlamError {
  double max = 0.0;
  double min = 0.0;
  double median = 0.0;
  double rmse = 0.0;
};

// SLAM on one sequence with one configuration, once: Tables 6 to 8.
struct SlamRow {
  std::string recording;
  std::string configuration;  // "off", "paper", "usual", "default"
  int seed = 0;
  int num_frames = 0;
  int num_measured = 0;  // frames whose pose was measured
  bool is_scale_free = false;
  std::optional<SlamError> ate_m;
  int loops_true = 0;
  int loops_false = 0;
  int loops_unknown = 0;
  double frames_per_second = 0.0;  // without reading
  std::vector<PathPoint> path;     // thinned, for figures
  std::vector<PathLoop> loops;
};

// As they stand in results.json and in the folder of rows. From JSON: throws nlohmann's exceptions
// where something is missing.
void to_json(nlohmann::json& json, const RecognitionRow& row);
void from_json(const nlohmann::json& json, RecognitionRow& row);
void to_json(nlohmann::json& json, const SlamRow& row);
void from_json(const nlohmann::json& json, SlamRow& row);

}  // namespace samewhere::paper
