#pragma once

#include <array>
#include <filesystem>

#include <samewhere/core/truth.hpp>
#include <samewhere/input/config.hpp>
#include <samewhere/input/recording.hpp>

namespace samewhere::input {

// Matrices of same places as data sets publish them: one row a query, 1 where a frame shows the
// same place. Often only one triangle is filled, and there are more rows than images, or fewer.

// The file in the folder or in its masks/: *GroundTruth*.txt or *TextFormat*.txt (0, 1 and 2
// between commas or blanks), or *GroundTruth*.mat, *_GT*.mat or GT_*.mat; text before MATLAB. Small
// and capital letters are the same. A text whose first line has other numbers is a trajectory.
// Empty: there is none.
std::filesystem::path published_matrix(const std::filesystem::path& folder);

// The traverses of GardensPoint, in their order.
inline constexpr std::array<const char*, 3> kTraverses = {"day_left", "day_right", "night_right"};

// Whether the folder says which of its frames show the same place: same_place.pgm or .txt, a
// published matrix, or two traverses of GardensPoint. Nothing is read.
bool has_place_truth(const std::filesystem::path& folder);

// Both triangles are one: two frames show the same place if either entry says so. Throws InputError
// if the file cannot be read, is not square, has more than kMaxPlaceRows rows or another value than
// 0, 1 and 2.
core::PlaceTruthMatrix read_published_matrix(const std::filesystem::path& file);

// The truth of the frames that a matrix of n rows belongs to. Of a matrix with more rows than there
// are frames each takes the row that the number in its name says (from 0, or from 1 if no name has
// 0), as where one of two cameras is used. Of one with fewer rows each k-th image stays a frame,
// k the whole number that fits, which is told in the log. Throws InputError, which begins with the
// file, if neither fits.
void set_places(const std::filesystem::path& file, const core::PlaceTruthMatrix& matrix,
                Recording& recording);

// Each row: `same` at a column makes the columns within so many frames `same`, too.
void widen(int tolerance_frames, core::PlaceTruthMatrix& places);

// Where the recording has no matrix of same places, takes the published one of the folder. What is
// broken is warned of in the log and left out. Then widens by config.truth_tolerance_frames.
void add_published_places(const std::filesystem::path& folder, const Config& config,
                          Recording& recording);

}  // namespace samewhere::input
