#pragma once

#include <memory>
#include <string>
#include <vector>

#include <samewhere/core/truth.hpp>
#include <samewhere/evaluate/consistency.hpp>
#include <samewhere/pipeline/stages.hpp>
#include <samewhere/pipeline/tracking.hpp>

namespace samewhere::pipeline {

struct SlamTestHooks;  // slam_test_hooks.hpp

// Visual SLAM: frames in; poses, a map and a ledger of loop candidates out. Tracking works on the
// caller's thread. Mapping, loop closing and full bundle adjustment work on a thread each
// (`threads`), or on the caller's. Results are applied at fixed frame and keyframe numbers, not on
// arrival, so single- and multi-threaded runs are identical to the bit.
class Slam {
 public:
  // `keep_map` is called in mapping's thread, see KeepMap.
  explicit Slam(const Config& config, DepthFrom depth_from = DepthFrom::kSensor,
                KeepMap keep_map = {});
  // In a known map: lost until relocalized. kExtend: the map grows from there on; kLocalize: it
  // stays as it is. The map has a keyframe, and was made with the settings of map_header().
  enum class Use { kExtend, kLocalize };
  Slam(const Config& config, const scene::StoredMap& known, Use use, KeepMap keep_map = {});
  Slam(const Config& config, DepthFrom depth_from, const SlamTestHooks& hooks);
  Slam(const Config& config, const scene::StoredMap& known, Use use, const SlamTestHooks& hooks);
  Slam(const Slam&) = delete;
  Slam& operator=(const Slam&) = delete;

  // Before the first frame: odometry from a file gives the poses of a new map, and predicts those
  // in a known one. Goes with the settings `odometry`, whose file is named.
  void follow(std::shared_ptr<const OdometryPath> odometry);

  // Before the first frame, with `threads`: feed() does not wait for mapping. Results are applied
  // to the first frame for which they are ready, so that a run is not repeatable; a lost camera is
  // searched for in every few frames, not in each. What still waits: (re-)initialization, and the
  // first frame after a gap in the recording.
  void never_wait() { tracking_.never_wait(); }

  // Frames are numbered from 0, in session(). Their images are shared and must not be written to.
  // Throws what a stage threw; after that no call may follow.
  void feed(const core::Frame& frame);
  // The input has ended: completes what is in progress. Throws as feed() does.
  void finish();

  std::uint16_t session() const { return tracking_.session(); }
  // One entry per frame fed.
  const std::vector<core::FramePose>& frames() const { return tracking_.frames(); }
  // Between two frames: no keyframe is inserted from here on, and the map is not discarded; false:
  // they are again.
  void set_map_fixed(bool is_fixed) { tracking_.set_map_fixed(is_fixed); }
  // The frame that was fed last, in the map that it was tracked in; that map; verdicts that mapping
  // told with it. After finish(): the verdicts that came later.
  const NewestFrame& newest() const { return tracking_.newest(); }
  const scene::MapVersion& visible_map() const { return tracking_.visible_map(); }
  const core::Ledger& newest_rows() const {
    return is_finished_ ? last_rows_ : tracking_.newest_rows();
  }
  std::uint64_t describer_checksum() const {
    return stages_.loop_closing().index().describer_checksum();
  }

  // State of the session after the last frame.
  SessionPhase phase() const { return tracking_.phase(); }
  // Why the last views that were tried did not begin a map, in words.
  std::string why_not_initialized() const { return tracking_.why_not_initialized(); }
  // Monocular: where the scale is suspected to have drifted, in the order of time.
  const std::vector<track::ScaleDriftInterval>& scale_drift() const {
    return tracking_.scale_drift();
  }
  // Whether images agree with odometry from a file. Zeros without one.
  ImageAgreement odometry_agreement() const { return tracking_.odometry_agreement(); }
  // How the relocalizations of the session ended.
  const RelocalizationCounts& relocalizations() const { return tracking_.relocalizations(); }
  // How often the map, with all its poses, was discarded for a new one.
  int num_reinitializations() const { return tracking_.num_reinitializations(); }

  // From here on: after finish().
  const scene::MapVersion& map() const;
  // The verdicts of the loop verifier, then the changes that the pose graph made to them.
  const core::Ledger& ledger() const;
  // Of the views that retrieval searches, oldest first.
  std::vector<core::Descriptor> descriptors() const;
  core::Timings timings() const;
  // Of the stages that do not work on the caller's thread.
  double processor_ms_beside() const;

 private:
  void require_finished() const;

  Stages stages_;  // tracking sends to them
  Tracking tracking_;
  core::Ledger ledger_;     // after finish()
  core::Ledger last_rows_;  // that came after the last frame
  bool is_finished_ = false;
  bool is_broken_ = false;  // a stage has thrown
};

// Pose of camera 0 at a frame that has one, provisional or not, after all corrections, derived from
// its reference keyframe.
core::Rigid3 world_from_camera(const scene::MapVersion& map, const core::FramePose& frame);
// At each measured frame whose pose is not provisional.
core::Trajectory trajectory_of(const scene::MapVersion& map,
                               const std::vector<core::FramePose>& frames);
// The same without loop closures.
core::Trajectory odometry_of(const scene::MapVersion& map,
                             const std::vector<core::FramePose>& frames);
// Odometry of a session without loop closures, over disjoint chains of `num_edges` > 0 edges, with
// the covariance of the drift model.
std::vector<evaluate::MeasuredMotion> odometry_chains_of(const scene::MapVersion& map,
                                                         std::uint16_t session, int num_edges);

}  // namespace samewhere::pipeline
