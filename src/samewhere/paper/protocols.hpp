#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <samewhere/core/source.hpp>
#include <samewhere/pipeline/config.hpp>

namespace samewhere::paper {

// How a public data set is evaluated (docs/data.md), and what a complete download of it holds.
struct Protocol {
  std::string data_set;
  int window_frames = -1;    // exclusion window; -1: window_s
  double window_s = 0.0;     // the same in seconds
  int tolerance_frames = 0;  // by which rows of the matrix of same places are widened
  int num_images = 0;        // as published; 0: not known, or it differs by sequence
  bool has_depth = false;
  std::string place_file;  // which says which frames show the same place
  std::string pose_file;   // true poses; empty: none is published
};

// Of the data set in the folder, which is known by its name (small and capital letters and signs
// between words do not count: Lip6Indoor, lip6_indoor) or by files in it. Nothing: none of the
// table.
std::optional<Protocol> protocol_of(const std::filesystem::path& folder);

// The config with window and tolerance of the protocol. A window or tolerance that the config sets
// itself (retrieve.window_frames, input.truth_tolerance_frames from 0 on) stays.
pipeline::Config with_protocol(pipeline::Config config, const Protocol& protocol);

// What the protocol needs and the recording lacks, each a few words ("84 of 388 images"); empty:
// it is complete.
std::vector<std::string> missing_of(const Protocol& protocol, const core::SourceInfo& info,
                                    const core::Truth& truth);

// Frames with a same place outside the window, among those before them.
int num_queries_with_loop(const core::PlaceTruthMatrix& places, int window_frames);

// All folders in `root`, up to three levels down, that protocol_of knows and that say which of
// their frames show the same place, or have the depth and true poses that tell it; in the order of
// the table, then by path. Folders that cannot be read are passed over. Throws InputError if there
// is no such folder `root`.
std::vector<std::filesystem::path> find_data_sets(const std::filesystem::path& root);

// What is measured where no source is named: the data sets in `root` (empty: none), then four
// rendered sequences, each with the window of its protocol. Throws as find_data_sets.
std::vector<std::string> default_sources(const std::filesystem::path& root);

// The rendered sequence that a quick run measures: one of the four, walked in half the time.
std::string quick_source();

}  // namespace samewhere::paper
