#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <samewhere/dense/config.hpp>
#include <samewhere/describe/config.hpp>
#include <samewhere/features/config.hpp>
#include <samewhere/input/config.hpp>
#include <samewhere/map/config.hpp>
#include <samewhere/optimize/config.hpp>
#include <samewhere/retrieve/config.hpp>
#include <samewhere/track/config.hpp>
#include <samewhere/twin/front/config.hpp>
#include <samewhere/verify/config.hpp>

namespace samewhere::pipeline {

// Every setting of the program: one section per folder. Defaults are profile `default`.
struct Config {
  std::string source;  // what was run; makes config.yaml of a run complete
  int seed = 0;
  bool threads = true;
  bool close_loops = true;
  input::Config input;
  twin::Config twin;
  features::Config features;
  describe::Config describe;
  retrieve::Config retrieve;
  track::Config track;
  map::Config map;
  verify::Config verify;
  optimize::Config optimize;
  dense::Config dense;
};

inline void visit_fields(Config& config, core::FieldVisitor& visit) {
  visit("source", config.source,
        {.help = "what was run; written by the program, read by `samewhere eval`"});
  visit("seed", config.seed, {.help = "of everything random", .min = 0});
  visit("threads", config.threads,
        {.help = "`run`: tracking, mapping and loop closing in a thread each; `loops`: describing, "
                 "searching and judging; the results are the same"});
  visit("close_loops", config.close_loops,
        {.help = "`run`: places seen before are looked for and correct the map; false: nothing is "
                 "corrected, but who is lost is still looked for"});
  visit("input", config.input, {.help = "Reading recordings"});
  visit("twin", config.twin, {.help = "The twin building"});
  visit("features", config.features, {.help = "Points of interest and their matches"});
  visit("describe", config.describe, {.help = "What a whole view looks like"});
  visit("retrieve", config.retrieve, {.help = "Which earlier views look alike"});
  visit("track", config.track, {.help = "Where the camera is"});
  visit("map", config.map, {.help = "Which views are kept"});
  visit("verify", config.verify, {.help = "Whether a candidate is the same place"});
  visit("optimize", config.optimize, {.help = "Solvers"});
  visit("dense", config.dense, {.help = "Cloud, grid and octree of a finished run"});
}

// How features are matched where who is lost looks for his place: that is only proposed, and held
// against others. A loop, which bends the map, is judged by config.features as it is.
features::Config features_of_lost(const Config& config, bool is_without_depth);

// Names of the built-in profiles: "default", "recognition" (of `samewhere loops`), "paper".
std::vector<std::string> profile_names();

// A built-in profile. Throws InputError naming the known ones.
Config profile(const std::string& name);

// The profile, then the file (empty: none), then the assignments "section.key=value", in this
// order. Throws InputError.
Config load_config(const std::string& profile_name, const std::filesystem::path& file,
                   const std::vector<std::string>& assignments);

}  // namespace samewhere::pipeline
