#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <samewhere/core/frame.hpp>
#include <samewhere/twin/building/presets.hpp>
#include <samewhere/twin/front/config.hpp>
#include <samewhere/twin/motion/motion.hpp>
#include <samewhere/twin/motion/people.hpp>
#include <samewhere/twin/motion/wheel.hpp>
#include <samewhere/twin/truth/truth.hpp>

namespace samewhere::twin {

inline constexpr double kFrameRate_hz = 15.0;

// A walk through rendered buildings before any picture is taken: what stands where, where the
// camera is at every frame, what its inertial unit and a robot's wheels say. Stays where it is.
class Walkthrough {
 public:
  // Throws InputError if the spec names no preset, or if nothing can be rendered (can_render).
  Walkthrough(const Spec& spec, const Config& config);
  Walkthrough(const Walkthrough&) = delete;
  Walkthrough& operator=(const Walkthrough&) = delete;

  const Spec& spec() const { return spec_; }
  // For titles and folders: "hotel-seed3".
  const std::string& name() const { return name_; }
  int num_frames() const { return static_cast<int>(walk_.poses.size()); }
  double stamp_s(int frame) const { return walk_.poses[static_cast<std::size_t>(frame)].stamp_s; }
  const std::shared_ptr<const core::Rig>& rig() const { return rig_; }
  const Walk& walk() const { return walk_; }
  const Motion& motion() const { return motion_; }
  const std::vector<Visit>& visits() const { return visits_; }
  const std::vector<Person>& people() const { return people_; }

  // A frame that has everything but its pictures.
  core::Frame frame_without_pictures(int index) const;
  // Up to the last frame; empty if no robot walks.
  std::vector<WheelSample> wheels() const;
  // Of every frame.
  std::vector<core::InertialTruth> inertial_truth() const;
  // Exact. The first call takes some seconds, later ones none; from one thread. What `watch` throws
  // comes out, and nothing is kept.
  const WalkTruth& truth(const WatchPairs& watch = nullptr) const;

 private:
  // Measured since the frame before, that frame's own moment excluded; of frame 0 the first sample.
  std::span<const core::ImuSample> imu_since_last(int frame) const;

  Spec spec_;
  std::string name_;
  World world_;
  Motion motion_;
  std::shared_ptr<const core::Rig> rig_;
  Walk walk_;
  std::vector<RayScene> rays_;  // of the visits
  std::vector<Visit> visits_;
  std::vector<Person> people_;
  std::vector<core::ImuSample> imu_;
  mutable std::optional<WalkTruth> truth_;  // computed on first use
};

// truth() with a progress line on stderr. Throws core::Interrupted after Ctrl-C.
const WalkTruth& watched_truth(const Walkthrough& walk);

}  // namespace samewhere::twin
