#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <samewhere/core/text_file.hpp>
#include <samewhere/core/truth.hpp>

namespace samewhere::input {

// The largest matrix of same places that data sets publish and that is read: 20,000 x 20,000 take
// 400 MB.
inline constexpr int kMaxPlaceRows = 20'000;

// One value of a matrix of same places. Throws InputError, which begins with `place`, if it is not
// 0 (different), 1 (same) or 2 (near).
core::PlaceTruth place_truth_of_value(double value, const std::string& place);

// What lies in the folder under the names that every format shares: the trajectory in
// groundtruth.tum; which frames show the same place in same_place.pgm (binary PGM) or, without it,
// same_place.txt (one row of numbers per query), both with 1 = same, 2 = near, 0 = different;
// aliased pairs in aliased_pairs.csv (a line of names, then query,match,...).
// What is broken is warned of in the log and left out: rows of a trajectory, a matrix that is not
// num_frames x num_frames, a file that cannot be read. Truth is not needed for a run.
core::Truth read_truth(const std::filesystem::path& folder, int num_frames);

// The trajectory in a file of the TUM format (core/tum_file.hpp) or the like. Rows that cannot be
// read (nan where motion capture lost the body), and rows whose stamp an earlier row has, are left
// out, counted and warned of; rows out of order are sorted. Never throws for what is in the file.
core::Trajectory read_true_trajectory(const std::filesystem::path& file);

// The same of a file of another kind.
struct TrajectoryFormat {
  std::vector<core::TextLine> (*read_lines)(const std::filesystem::path& file);
  // Throws InputError for a line that holds no pose.
  core::StampedPose (*pose_of)(const core::TextLine& line);
};
core::Trajectory read_true_trajectory(const std::filesystem::path& file,
                                      const TrajectoryFormat& format);

// Calls `read`; what it throws as InputError is warned of, with what follows from it ("is not
// used"), and false returned.
bool read_if_sound(const char* consequence, const std::function<void()>& read);

// A pose from the four rows of its matrix world_from_camera, 16 numbers. Throws InputError naming
// `line` if the matrix is no rigid transform.
core::Rigid3 rigid_from_rows(const core::TextLine& line, const std::vector<double>& rows);

}  // namespace samewhere::input
