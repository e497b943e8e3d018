#pragma once

#include <memory>
#include <vector>

#include <samewhere/core/truth.hpp>
#include <samewhere/evaluate/consistency.hpp>
#include <samewhere/pipeline/loop_closing.hpp>
#include <samewhere/pipeline/mapping.hpp>
#include <samewhere/pipeline/tracking.hpp>

namespace samewhere::pipeline {

// What the owner of a Slam may have done in its stages, in their threads. All may be empty.
struct SlamHooks {
  KeepMap keep_map;
  core::Dawdle dawdle;  // for tests
  // For tests: may put loops into what loop closing answers, in its thread.
  std::function<void(const ToLoopClosing& question, LoopAnswer& answer)> lie;
};

// The whole system: frames in, poses, a map and a ledger of judged loops out. Stages, each of which
// knows nothing of threads: tracking asks mapping, mapping asks loop closing and, now and then,
// bundling. Tracking works
// on the caller's thread; the others on a thread each (`threads`), or on the caller's. When an
// answer counts is a matter of frames and keyframes, never of time: the results are the same to the
// bit, however the threads run.
class Slam {
 public:
  explicit Slam(const Config& config, DepthFrom depth_from = DepthFrom::kSensor,
                const SlamHooks& hooks = {});
  // In a map that is there: lost until a place is recognised. kExtend: the map grows from there on;
  // kLocalize: it stays as it is. The map holds a keyframe, and was made with the settings that
  // map_header() names.
  enum class Use { kExtend, kLocalize };
  Slam(const Config& config, const scene::StoredMap& known, Use use, const SlamHooks& hooks = {});
  Slam(const Slam&) = delete;
  Slam& operator=(const Slam&) = delete;

  // Frames are numbered from 0, in session(). Their pictures are shared: nobody writes to them any
  // more. Throws what a stage threw; then nothing may follow.
  void feed(const core::Frame& frame);
  // Nothing comes any more: what is under way is done. Throws as feed() does.
  void finish();

  std::uint16_t session() const { return tracking_.session(); }
  // One entry per frame fed.
  const std::vector<core::FramePose>& frames() const { return tracking_.frames(); }
  std::uint64_t describer_checksum() const { return loop_closing_.index().describer_checksum(); }

  // Why there is no pose, as long as there is none: of the views tried last.
  std::string why_not_started() const { return tracking_.why_not_started(); }
  // Where the scale of a map without depth is suspected to have changed, in the order of time.
  const std::vector<track::ScaleDoubt>& scale_doubts() const { return tracking_.scale_doubts(); }
  // How often the map was given up for a new one, with all poses found in it.
  int num_starts_given_up() const { return tracking_.num_starts_given_up(); }

  // From here on: after finish().
  const scene::MapVersion& map() const;
  // The rows of the loop verifier, and behind them the later ones of the pose graph.
  const core::Ledger& ledger() const;
  // What the views that loops are looked for among look like, oldest first.
  std::vector<core::Descriptor> descriptors() const;
  core::Timings timings() const;
  // Spent by the stages beside the caller's thread.
  double processor_ms_beside() const;

 private:
  void require_finished() const;

  // in the order in which they are asked, from the last: each ends before those that it asks
  LoopClosing loop_closing_;
  std::unique_ptr<LoopLink> loop_link_;
  Bundling bundling_;
  std::unique_ptr<BundleLink> bundle_link_;
  Mapping mapping_;
  std::unique_ptr<MappingLink> mapping_link_;
  Tracking tracking_;
  core::Ledger ledger_;  // when it is finished
  bool is_finished_ = false;
  bool is_broken_ = false;  // a stage has thrown
};

// Pose of camera 0 at each measured frame, after all corrections: derived from the reference
// keyframes.
core::Trajectory trajectory_of(const scene::MapVersion& map,
                               const std::vector<core::FramePose>& frames);
// The same as if no loop had been closed.
core::Trajectory odometry_of(const scene::MapVersion& map,
                             const std::vector<core::FramePose>& frames);
// Odometry of a session over chains of num_edges > 0 edges that share none, as well as it is known
// without loops, with what the drift model says of it.
std::vector<evaluate::MeasuredMotion> odometry_chains_of(const scene::MapVersion& map,
                                                         std::uint16_t session, int num_edges);

}  // namespace samewhere::pipeline
