#pragma once

#include <memory>
#include <optional>

#include <samewhere/pipeline/config.hpp>
#include <samewhere/pipeline/odometry_path.hpp>
#include <samewhere/pipeline/visible_map.hpp>
#include <samewhere/track/tracker.hpp>

namespace samewhere::pipeline {

// Of the frames with odometry and a pose by their images.
struct ImageAgreement {
  int num_compared = 0;
  int num_contradicted = 0;  // beyond the covariances (odometry_images.hpp)
};

// Frames posed by odometry from a file: the pose of the newest keyframe, composed with the motion
// since. Features tell which landmarks a view shows, and what odometry in a plane does not measure
// (odometry_images.hpp); no visual pose replaces that of odometry.
class OdometryTracking {
 public:
  OdometryTracking(const Config& config, std::shared_ptr<const OdometryPath> path)
      : config_(config), path_(std::move(path)) {}

  bool has_pose(double stamp_s) const { return path_->world_from_body(stamp_s).has_value(); }
  // Of the body at `to` in that at `from`; nothing if one of them has no pose.
  std::optional<core::Rigid3> motion(double from_s, double to_s) const;

  // Before track(): the image before the view. Over a second with neither images nor odometry the
  // camera may have been taken to a look-alike place, which images cannot tell from the newest
  // keyframe.
  void note_images(double last_s, double view_s);

  // The view relative to the newest keyframe. Weak: too few of its features show landmarks for a
  // visual pose; then it has none. In a gap of odometry features give the pose, near `guessed` of
  // the body in the reference of the map; nothing if they cannot.
  std::optional<scene::TrackedView> track(const features::View& view, const VisibleMap& map,
                                          const core::Rigid3& guessed,
                                          const track::Tracker& tracker);

  const ImageAgreement& agreement() const { return agreement_; }

  // Far enough from the newest keyframe, or with other landmarks.
  bool is_worth_keeping(const scene::MapVersion& map, const scene::TrackedView& tracked) const;

 private:
  bool is_before_unseen(const scene::Keyframe& keyframe) const;

  Config config_;
  std::shared_ptr<const OdometryPath> path_;
  std::optional<double> unseen_until_s_;
  ImageAgreement agreement_;
};

}  // namespace samewhere::pipeline
