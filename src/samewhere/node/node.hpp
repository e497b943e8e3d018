#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include <samewhere/input/transforms.hpp>
#include <samewhere/node/config.hpp>
#include <samewhere/node/grid_output.hpp>
#include <samewhere/node/incoming.hpp>
#include <samewhere/node/live_frames.hpp>
#include <samewhere/node/pairing.hpp>
#include <samewhere/node/publisher.hpp>
#include <samewhere/node/startup.hpp>
#include <samewhere/run/watcher.hpp>
#include <samewhere/slam.hpp>

namespace samewhere::node {

// SLAM on the messages of a robot. Knows no transport: one thread gives it what comes in, it gives
// out through a Publisher. A message that is not usable is counted and named in the diagnostics,
// and the node goes on.
class Node {
 public:
  // `options`: how the session works; never_wait is that of `config`, on_event is not used. The
  // publisher and the watcher, if any, outlive the node. Settings are checked with the first frame.
  Node(const Config& config, const Options& options, Publisher& publisher,
       run::Watcher* watcher = nullptr);
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;
  ~Node();

  // Does not throw for what comes from outside.
  void take(Incoming incoming);
  // Images that a queue in front of the node dropped.
  void count_dropped(std::uint64_t num_images) { counts_.num_dropped += num_images; }
  // The input has ended: completes what is in progress and tells its last events. Returns the
  // trajectory after all corrections; nothing if no session has begun.
  std::vector<StampedPose> finish();

  struct Counts {
    std::uint64_t num_frames = 0;   // tracked
    std::uint64_t num_dropped = 0;  // images
    std::uint64_t num_refused = 0;  // messages
    std::string last_refusal;
  };
  Counts counts() const;

 private:
  void take_one(ImageIn& in);
  void take_one(const CameraInfoIn& in);
  void take_one(const OdometryIn& in);
  void take_one(const TransformsIn& in);
  void take_one(const CommandIn& in);
  void take_one(const Tick& tick);

  void use(FrameSet frame);
  void try_to_start();
  void prepare_grid();
  void track(const FrameSet& frame);
  Answer execute(const Command& command);
  std::string carry_out(const Command& command);
  std::string begin_in(const std::filesystem::path& map, MapUse use);
  void take_odometry(double stamp_s, const messages::Vector3& position,
                     const messages::Quaternion& rotation);
  void refused(const std::string& why);

  bool has_odometry() const { return config_.odometry_from_tf || !odometry_.is_empty(); }
  void publish_frames(const Tracked& tracked);
  void publish_corrected_odometry();
  void publish_map_if_due(const Tracked& tracked);
  void publish_events();
  void publish_state();
  void set_status(const std::string& status);

  Config config_;
  Options options_;
  Publisher& publisher_;
  run::Watcher* watcher_;
  Counts counts_;
  Pairing pairing_;
  input::Transforms static_transforms_;
  OdometryBuffer odometry_;
  LiveFrames frames_;
  std::optional<Startup> startup_;  // until a session has begun
  std::string why_not_started_;     // no further try until a command
  std::optional<Setup> setup_;
  std::unique_ptr<Slam> slam_;
  std::optional<Tracked> newest_;
  std::optional<Tracked> waiting_for_odometry_;  // until odometry has reached its stamp
  Pose map_from_given_odom_ = Pose::Identity();
  std::string status_;
  bool is_paused_ = false;
  std::optional<double> map_told_s_;
  std::uint64_t map_version_told_ = 0;
  std::optional<GridOutput> grid_;
};

}  // namespace samewhere::node
