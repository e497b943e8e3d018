#pragma once

#include <cstdint>
#include <vector>

#include <samewhere/event.hpp>
#include <samewhere/pipeline/slam.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::library {

// What happened in a session from one frame to the next, by comparison.
class EventLog {
 public:
  explicit EventLog(const scene::MapVersion& known) : before_(known) {}

  // After each frame that was fed.
  std::vector<Event> update(const pipeline::Slam& slam);
  // After the session is finished.
  std::vector<Event> finish(const pipeline::Slam& slam);

 private:
  void add_verdicts(const core::Ledger& rows);
  void add_map_changes(const scene::MapVersion& map);
  void add_correction(const scene::MapVersion& map);
  void add_tracking_changes(const pipeline::Slam& slam);
  template <class What>
  void add(What what) {
    events_.push_back({frame_, stamp_s_, std::move(what)});
  }

  scene::MapVersion before_;
  int num_reinitializations_ = 0;
  pipeline::RelocalizationCounts counts_;
  bool had_pose_ = false;
  double last_pose_s_ = 0.0;
  std::uint64_t frame_ = 0;  // of the newest events
  double stamp_s_ = 0.0;
  std::vector<Event> events_;
};

}  // namespace samewhere::library
