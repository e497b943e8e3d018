// What stands for mat_file.cpp in a build without libmatio (-DSAMEWHERE_MATIO=OFF, or not
// installed).
#include <samewhere/core/errors.hpp>
#include <samewhere/input/mat_file.hpp>

namespace samewhere::input {

core::PlaceTruthMatrix read_mat_matrix(const std::filesystem::path& file) {
  throw core::InputError(file.string() +
                         ": built without MATLAB files (SAMEWHERE_MATIO), expected a build with "
                         "libmatio, or the matrix as text");
}

}  // namespace samewhere::input
