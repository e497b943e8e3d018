#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <samewhere/core/folder_lock.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/report/record.hpp>

namespace samewhere::run {

// Which files are wanted; an empty path: not this one.
struct DenseFiles {
  std::filesystem::path cloud;   // PLY
  std::filesystem::path grid;    // without the endings .pgm and .yaml of its two files
  std::filesystem::path octree;  // OctoMap's .bt
};

struct DenseOutcome {
  std::vector<report::Figure> figures;
  std::optional<std::string> no_grid;  // why there is none although it was wanted
};

// The dense maps of a finished run: its source is read once more, and the depth of its keyframes
// (frames.csv) fused from where they are in trajectory.tum. A pair of pictures without depth images
// is matched for depth. `config` is that of the run, with the dense settings to use. Progress on
// stderr. The files are written whole and get their names together, the grid's description last:
// one that is there goes with its picture. `held`: the lock of the run's folder, where the caller
// has it. Throws InputError if a file of the run is missing or broken, if the source is gone or
// another one, if it has no depth or none in range, or if a file cannot be written; Interrupted
// after Ctrl-C.
DenseOutcome make_dense_maps(const std::filesystem::path& run, const pipeline::Config& config,
                             const DenseFiles& files, const core::FolderLock* held = nullptr);

}  // namespace samewhere::run
