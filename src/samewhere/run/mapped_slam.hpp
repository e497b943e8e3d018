#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include <samewhere/pipeline/slam.hpp>
#include <samewhere/run/map_saver.hpp>
#include <samewhere/scene/map_file.hpp>

namespace samewhere::run {

// What a run does with map files. Empty paths: nothing.
struct MapPlan {
  std::filesystem::path known;  // a map to start in, lost; then nothing is saved elsewhere
  bool is_known_fixed = false;  // localise only; else the known map grows
  // Called once, when there is a first frame that the known map, if any, fits: nothing is written
  // before, nor at all if the source gives none. Returns a new file for the map, which grows with
  // it, a commit per keyframe. May be empty.
  std::function<std::filesystem::path()> begin = {};
  // Called in mapping's thread with each map that is kept. May be empty.
  pipeline::KeepMap watch = {};
};

// A Slam, in a known map or from nothing, and what keeps its map.
class MappedSlam {
 public:
  // Throws InputError if the known map cannot be used: it is none, is being written to, or differs
  // from the run in where depth comes from.
  MappedSlam(const pipeline::Config& config, pipeline::DepthFrom depth_from, const MapPlan& plan);
  MappedSlam(const MappedSlam&) = delete;
  MappedSlam& operator=(const MappedSlam&) = delete;

  const pipeline::Slam& slam() const { return *slam_; }
  // As in Slam. A map that is known and fixed stays so.
  void never_wait() { slam_->never_wait(); }
  void set_map_fixed(bool is_fixed) { slam_->set_map_fixed(is_fixed || plan_.is_known_fixed); }
  // Whether the scale is metric: this run or those that made the map measured depth.
  bool is_metric() const { return is_metric_; }

  // Of keyframes, once it is finished.
  std::map<core::FrameId, std::string> take_thumbnails() { return std::move(thumbnails_); }

  // As Slam::follow(). Lengths of a new map are metric then.
  void follow(std::shared_ptr<const pipeline::OdometryPath> odometry);
  // As Slam::feed(); the frame gets its session. Throws InputError if the known map was made with
  // other settings or another camera.
  void feed(core::Frame& frame);

  // Closes the file. What could not be saved, if anything.
  std::optional<std::string> finish();

 private:
  void begin();
  void keep(const scene::MapVersion& map, const pipeline::MapNews& news);
  void take_known(const core::Rig& rig);

  pipeline::Config config_;
  MapPlan plan_;
  bool is_metric_;
  std::optional<scene::MapFile> known_;         // until the first frame
  std::optional<core::Descriptor> known_view_;  // one of its views
  std::optional<MapSaver> saver_;
  std::map<core::FrameId, std::string> thumbnails_;  // written in mapping's thread
  std::optional<pipeline::Slam> slam_;               // last: its threads end before what they use
};

}  // namespace samewhere::run
