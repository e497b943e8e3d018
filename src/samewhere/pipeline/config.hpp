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
#include <samewhere/pipeline/odometry_config.hpp>
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
  OdometryConfig odometry;
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

// The keys of earlier versions, with their names now: the reader refuses the old ones.
void visit_renamed_keys(core::FieldVisitor& visit);

inline void visit_fields(Config& config, core::FieldVisitor& visit) {
  visit_renamed_keys(visit);
  visit("source", config.source,
        {.help = "recording that was run; written by the program, read by `samewhere eval`"});
  visit("seed", config.seed, {.help = "seed of all random numbers", .min = 0});
  visit("threads", config.threads,
        {.help = "`run`: tracking, mapping and loop closing in a thread each; `loops`: "
                 "description, retrieval and verification; the results are identical"});
  visit("close_loops", config.close_loops,
        {.help = "`run`: accepted loops correct the map; false: loop closing is off, "
                 "relocalization is not"});
  visit("input", config.input, {.help = "Reading recordings"});
  visit("odometry", config.odometry,
        {.help = "Odometry from a file (decision 033)",
         .is_used = config.source.empty() || config.odometry.is_used()});
  const bool renders = config.source.empty() || config.source.starts_with("twin:");
  visit("twin", config.twin, {.help = "The twin building", .is_used = renders});
  visit("features", config.features, {.help = "ORB features and their matches"});
  visit("describe", config.describe, {.help = "Global image descriptors"});
  visit("retrieve", config.retrieve, {.help = "Place recognition: retrieval of loop candidates"});
  visit("track", config.track, {.help = "Tracking"});
  visit("map", config.map, {.help = "Mapping: keyframes, landmarks, bundle adjustment"});
  visit("verify", config.verify, {.help = "Loop verification"});
  visit("optimize", config.optimize, {.help = "Bundle adjustment and pose graph optimization"});
  visit("dense", config.dense,
        {.help = "Point cloud, occupancy grid and octree of a finished run"});
}

// Feature matching in relocalization. Its hypotheses compete with each other, so that the ratio
// test can be wider than that of loops.
features::Config features_of_lost(const Config& config, bool is_without_depth);

// Names of the built-in profiles: "default", "recognition" (of `samewhere loops`), "paper", "usual"
// (bag of words and geometry alone, to compare with).
std::vector<std::string> profile_names();

// A built-in profile. Throws InputError naming the known ones.
Config profile(const std::string& name);

// The profile, then the file (empty: none), then the assignments "section.key=value", in this
// order. Throws InputError.
Config load_config(const std::string& profile_name, const std::filesystem::path& file,
                   const std::vector<std::string>& assignments);

}  // namespace samewhere::pipeline
