#pragma once

#include <filesystem>

#include <samewhere/core/truth.hpp>

namespace samewhere::input {

// A square matrix of numbers in a MATLAB file of version 5 to 7, full or sparse, compressed or not:
// the variable `truth`, or the only square matrix of numbers in it. Values as in same_place.txt
// (truth_file.hpp). Sizes are checked before memory is taken. Throws InputError if the file is cut
// short or damaged, of another version, holds no such matrix or one of more than kMaxPlaceRows
// rows; and always in a build without libmatio (-DSAMEWHERE_MATIO=OFF).
core::PlaceTruthMatrix read_mat_matrix(const std::filesystem::path& file);

}  // namespace samewhere::input
