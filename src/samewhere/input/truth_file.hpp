#pragma once

#include <filesystem>
#include <vector>

#include <samewhere/core/text_file.hpp>
#include <samewhere/core/truth.hpp>

namespace samewhere::input {

// What lies in the folder under the names that every format shares: the trajectory in
// groundtruth.tum; which frames show the same place in same_place.pgm (binary PGM) or, without it,
// same_place.txt (one row of numbers per query), both with 1 = same, 2 = near, 0 = different;
// which pairs are impostors in impostors.csv (a line of names, then query,match,...).
// Throws InputError if a file is broken or the matrix is not num_frames x num_frames.
core::Truth read_truth(const std::filesystem::path& folder, int num_frames);

// A pose from the four rows of its matrix world_from_camera, 16 numbers. Throws InputError naming
// `line` if the matrix is no rigid transform.
core::Rigid3 rigid_from_rows(const core::TextLine& line, const std::vector<double>& rows);

}  // namespace samewhere::input
