#pragma once

#include <filesystem>
#include <optional>

#include <samewhere/input/config.hpp>
#include <samewhere/input/recording.hpp>

namespace samewhere::input {

// Each find_ function reads the folder if it holds a recording of that format; nothing if it does
// not. All text files are read and checked here, images are not. Throws InputError naming the file
// (and line) that is missing or broken, if it is needed. What is not needed is warned of: ground
// truth and inertial measurements, rows of them, and pictures that are missing, unless more than
// half of all are. config.camera stands in for a calibration that cannot be read; without
// config.needs_calibration none has to be there.

// rgb.txt and depth.txt (lines `stamp filename`, or `stamp,filename`), groundtruth.txt, camera.txt.
// Without depth.txt or rgb.txt, the pairs of associations.txt (list_file.hpp; also associate.txt,
// assoc.txt). A colour image without a depth image near in time has no depth. If that is so of all
// of them, InputError; if of more than half, a warning in the log. Without config.depth, depth.txt
// is not looked at.
std::optional<Recording> find_tum_rgbd(const std::filesystem::path& folder, const Config& config);

// frame-000000.color.png (or .jpg), .depth.png, .pose.txt (world from camera, 4 x 4), camera.txt.
std::optional<Recording> find_seven_scenes(const std::filesystem::path& folder,
                                           const Config& config);

// images/, depth/ (depth_folder.hpp), K.txt, poses.txt (one world from camera a line, row by row).
// This is how the HoloLens samples of DeepVideoMVS (Duzceker et al. 2021) are laid out.
std::optional<Recording> find_hololens(const std::filesystem::path& folder, const Config& config);

// mav0/cam0/data.csv and sensor.yaml, where they are also those of cam1, imu0 and
// state_groundtruth_estimate0: the ASL format of Burri et al. 2016. `folder` may be mav0 itself.
// One picture a frame and camera: those of cam1 belong to the nearest in time of cam0, and those of
// cam0 without one are left out.
std::optional<Recording> find_euroc(const std::filesystem::path& folder, const Config& config);

// image_0/ and image_1/ (grey) or else image_2/ and image_3/ (colour) with 000000.png and so on (or
// another format of pictures),
// times.txt (one stamp a line), calib.txt (P0 to P3); poses.txt or ../../poses/NAME.txt (the first
// three rows of world from camera 0 a line): an odometry sequence of Geiger et al. 2012. The right
// camera may be missing.
std::optional<Recording> find_kitti(const std::filesystem::path& folder, const Config& config);

// The pictures of the folder in their order (file_names.hpp) with the stamps that their names tell
// (name_stamps.hpp), camera.txt.
std::optional<Recording> find_images(const std::filesystem::path& folder, const Config& config);

// The same of a folder within: rgb/, color/, colour/, image/ or images/; with depth/ beside it, if
// it is there (depth_folder.hpp), and camera.txt or K.txt.
std::optional<Recording> find_picture_folders(const std::filesystem::path& folder,
                                              const Config& config);

// That, if there is a folder of depth images.
std::optional<Recording> find_colour_and_depth(const std::filesystem::path& folder,
                                               const Config& config);

// color.txt and aligned_depth.txt (lines `stamp filename`), sensors.yaml, groundtruth.txt of
// base_link, brought to the colour camera by trans_matrix.yaml: a sequence of OpenLORIS-Scene (Shi
// et al. 2020). Without trans_matrix.yaml there is no trajectory. depth/ is not registered and not
// read.
std::optional<Recording> find_open_loris(const std::filesystem::path& folder, const Config& config);

// FRONTAL/FRONTAL_<seconds>.png, camera.txt, *-GROUNDTRUTH.csv (stamp, x, y, theta, covariance) of
// the robot, or *-GT-extended.csv: Bicocca of Rawseeds (Ceriani et al. 2009).
std::optional<Recording> find_rawseeds(const std::filesystem::path& folder, const Config& config);

// At least two of day_left/, day_right/ and night_right/, one traverse after another in this order.
// Pictures of one number show the same place, those within 8 are near;
// config.truth_tolerance_frames makes those within it the same.
std::optional<Recording> find_gardens_point(const std::filesystem::path& folder,
                                            const Config& config);

// Images/*, or pictures in the folder itself, with a published matrix of same places
// (place_matrix.hpp): Lip6 Indoor and Outdoor (Angeli et al. 2008), one picture a second, and New
// College and City Centre of FAB-MAP (Cummins and Newman 2008), left and right in turn, without
// stamps: one a second is assumed.
std::optional<Recording> find_place_set(const std::filesystem::path& folder, const Config& config);

// A text file with the path of one image a line, relative to the list (list_file.hpp); further
// columns are ignored. A list carries neither camera nor truth.
Recording read_image_list(const std::filesystem::path& list, const Config& config);

}  // namespace samewhere::input
