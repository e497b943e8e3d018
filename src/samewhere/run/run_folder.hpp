#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <samewhere/core/ledger.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/report/pair_figure.hpp>
#include <samewhere/report/record.hpp>
#include <samewhere/report/table.hpp>

namespace samewhere::run {

// The folder of the run that is meant: `path` itself, or of a map file (NAME.sw) the folder that it
// lies in. Does not look whether a run has written it.
std::filesystem::path run_folder_of(const std::filesystem::path& path);

// The map file that is meant: `path` itself, or of a folder the map.sw in it.
std::filesystem::path map_file_of(const std::filesystem::path& path);

// The config that was in force in a finished run, then the assignments "section.key=value". Throws
// InputError if config.yaml is missing or broken, and for an assignment that is.
pipeline::Config config_of_run(const std::filesystem::path& folder,
                               const std::vector<std::string>& assignments = {});

// The last verdict on each candidate of a finished run; its lists are brought in step with its map
// (run_lists.hpp). Throws InputError as report::read_loops_json does.
core::Ledger ledger_of_run(const std::filesystem::path& folder);

// One of its rows. Throws InputError, naming the folder, if there are not so many.
const core::LedgerRow& row_of(const core::Ledger& ledger, std::size_t candidate,
                              const std::filesystem::path& folder);

// A candidate of a finished run with both views, from its map. Without depth the verifier may have
// used the keyframe that replaced a culled one, and counted other matches. Throws InputError if
// there is no map (recognition alone makes none, and a run with --map adds to that of another), the
// query was lost, or the map has no picture of one of them.
report::PairRecord pair_of_run(const std::filesystem::path& folder, const core::LedgerRow& row);

// The figures of a finished run, measured anew from the files in its folder against the truth that
// comes with its source (config.yaml says which), or where the file `truth` is named, against the
// trajectory in it (TUM format). Recognition alone is told by its matches.txt.
// Throws InputError if a file is missing or broken, if the source is no longer there, or if `truth`
// is named and shares no time with the run.
std::vector<report::Figure> evaluate_folder(const std::filesystem::path& folder,
                                            const std::filesystem::path& truth = {});

// The accepted loops of a recognition run over a walk through floors that look alike: how many join
// two floors (evaluate/tower_walk.hpp). `walk` is the list of images with floor and clip. Throws
// InputError.
std::vector<report::Figure> evaluate_walk(const std::filesystem::path& folder,
                                          const std::filesystem::path& walk);

// Where the time of a finished run went. Throws InputError if timing.json is missing or broken.
report::Table stages_of_folder(const std::filesystem::path& folder);

}  // namespace samewhere::run
