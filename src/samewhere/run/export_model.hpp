#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/types.hpp>

#include <samewhere/core/rig.hpp>
#include <samewhere/features/features.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::run {

// A feature of an exported view that observes a point.
struct ExportedFeature {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  // centre of the upper left pixel (0, 0)
  std::size_t point = 0;                            // position in ExportedModel::points
};

// A keyframe as structure from motion knows it.
struct ExportedView {
  core::FrameId frame;
  double stamp_s = 0.0;
  core::Rigid3 world_from_camera;
  std::vector<ExportedFeature> features;
};

// Feature `feature` of view `view` observes the point; both are positions.
struct ExportedObservation {
  std::size_t view = 0;
  std::size_t feature = 0;
};

struct ExportedPoint {
  Eigen::Vector3d in_world = Eigen::Vector3d::Zero();
  std::array<std::uint8_t, 3> rgb{};
  double error_px = 0.0;  // mean reprojection error of its observations
  std::vector<ExportedObservation> observations;
};

// Keyframes of one session and the landmarks that two of them observe, seen by camera 0. Camera and
// pixels belong to the exported pictures.
struct ExportedModel {
  core::PinholeRadtan camera;
  std::vector<ExportedView> views;  // by frame
  std::vector<ExportedPoint> points;
};

// What the exported pictures are: as the source gives them (rectified, straightened), or without
// distortion. SLAM saw them enlarged where they are small (input/enlarge.hpp).
struct ExportedPictures {
  cv::Size size_px;
  bool is_undistorted = false;
};

// Keyframes of a session that are part of the map, by frame. Throws InputError if there is none.
std::vector<const scene::Keyframe*> keyframes_of_session(const scene::MapVersion& map, int session);

// Camera 0 of the view for these pictures. Throws InputError if their shape is not that of the
// pictures that the view was made of.
core::PinholeRadtan camera_of_pictures(const features::View& view,
                                       const ExportedPictures& pictures);

// Throws InputError as these two do. An observation whose landmark is not in front of the camera is
// left out, and one outside of an undistorted picture.
ExportedModel model_of(const scene::MapVersion& map, int session, const ExportedPictures& pictures);

// Whether its pictures are not those of an ideal pinhole.
bool has_distortion(const core::PinholeRadtan& camera);

// The number of all observations, and the mean reprojection error of the points, px.
std::size_t num_observations(const ExportedModel& model);
double mean_error_px(const ExportedModel& model);

}  // namespace samewhere::run
