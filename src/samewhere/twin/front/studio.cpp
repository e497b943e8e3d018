#include <algorithm>

#include <samewhere/core/random.hpp>
#include <samewhere/core/stage_thread.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/twin/front/studio.hpp>
#include <samewhere/twin/render/depth_sensor.hpp>
#include <samewhere/twin/render/motion_blur.hpp>
#include <samewhere/twin/render/photograph.hpp>

namespace samewhere::twin {
namespace {

// What a covered lens lets through.
View nothing(const core::Camera& camera) {
  const cv::Size size(geometry::pinhole(camera).width_px, geometry::pinhole(camera).height_px);
  return {.radiance = cv::Mat::zeros(size, CV_32FC3),
          .depth_m = cv::Mat::zeros(size, CV_32F),
          .incidence = cv::Mat::zeros(size, CV_32F),
          .surface = cv::Mat(size, CV_32S, cv::Scalar(-1))};
}

}  // namespace

int num_threads(const Config& config) {
  return config.num_workers > 0 ? config.num_workers : core::num_hardware_threads();
}

Studio::Studio(const Walkthrough& walk, const Config& config)
    : walk_(walk), has_ideal_depth_(config.ideal_depth) {
  for (const auto& visit : walk.visits()) {
    // both cameras of a stereo pair are alike
    renderers_.emplace_back(*visit.building, *visit.rays, walk.rig()->cameras.front(),
                            num_threads(config));
  }
  exposures_ = automatic_exposures(mean_radiances(), kFrameRate_hz);
}

std::vector<float> Studio::mean_radiances() const {
  std::vector<float> radiances;
  for (std::size_t i = 0; i < walk_.walk().poses.size(); ++i) {
    const int visit = walk_.walk().visit_of_frame[i];
    radiances.push_back(
        visit == kDark ? 0.0F
                       : renderer_of(visit).mean_radiance(walk_.walk().poses[i].world_from_camera));
  }
  return radiances;
}

View Studio::view(int index, int camera) const {
  const auto at = static_cast<std::size_t>(index);
  const auto which = static_cast<std::size_t>(camera);
  const int visit = walk_.walk().visit_of_frame[at];
  if (visit == kDark) return nothing(walk_.rig()->cameras[which]);
  const core::Rigid3 world_from_camera =
      walk_.walk().poses[at].world_from_camera * walk_.rig()->body_from_camera[which];
  return renderer_of(visit).render(world_from_camera,
                                   rectangles_of(walk_.people(), walk_.stamp_s(index)));
}

cv::Mat Studio::picture(const View& view, int index, int camera) const {
  const auto which = static_cast<std::size_t>(camera);
  const Exposure& exposure = exposures_[static_cast<std::size_t>(index)];
  const double stamp_s = walk_.stamp_s(index);
  const double half_s = 0.5 * exposure.duration_s;
  const core::Rigid3& body_from_camera = walk_.rig()->body_from_camera[which];
  const CameraMotion motion = motion_between(
      walk_.motion().world_from_body(stamp_s - half_s) * body_from_camera,
      walk_.motion().world_from_body(stamp_s + half_s) * body_from_camera, exposure.duration_s);
  const cv::Mat blurred =
      blur_by_motion(view, walk_.rig()->cameras[which], motion, exposure.duration_s);
  const auto picture = static_cast<std::uint64_t>(2 * index + camera);
  return photograph(blurred, exposure, core::seed_of(walk_.spec().seed, "twin.picture", picture));
}

Pictures Studio::pictures(int index) const {
  Pictures pictures;
  const int num_cameras = static_cast<int>(walk_.rig()->cameras.size());
  for (int camera = 0; camera < num_cameras; ++camera) {
    const View seen = view(index, camera);
    pictures.images.push_back(picture(seen, index, camera));
    if (camera > 0 || walk_.spec().sensors != Sensors::kRgbd) continue;
    const std::uint64_t seed =
        core::seed_of(walk_.spec().seed, "twin.depth", static_cast<std::uint64_t>(index));
    // a covered lens sees none of the building, whichever visit's it is
    const int visit = std::max(walk_.walk().visit_of_frame[static_cast<std::size_t>(index)], 0);
    const Building& building = *walk_.visits()[static_cast<std::size_t>(visit)].building;
    pictures.depth_m = has_ideal_depth_ ? seen.depth_m : measure_depth(seen, building, seed);
  }
  return pictures;
}

}  // namespace samewhere::twin
