#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include <samewhere/core/ids.hpp>

namespace samewhere::track {

// Running median of positive values, in bins of 5 %, in constant memory.
class LogMedian {
 public:
  void add(double value);
  int size() const { return size_; }
  double value() const;  // of at least one

 private:
  static constexpr int kNumSteps = 1024;
  std::array<std::uint32_t, kNumSteps> counts_{};
  int size_ = 0;
};

// Detects that the scale of a monocular map has drifted. One view does not show it. But both the
// camera's speed and the depth of the visible landmarks then differ from their usual values by the
// same factor, while the image flow stays as usual. A standing camera, or one close to a wall,
// shows only one of the two. A camera that moves slowly and close to objects for long shows both: a
// detection is a suspicion. Lengths are in map units.
class ScaleDriftDetector {
 public:
  // `max_change`: larger or smaller by this factor is a drift; 1 or less: nothing is detected.
  explicit ScaleDriftDetector(double max_change) : max_change_(max_change) {}

  // One frame: distance to the frame before, and the median depth of its landmarks. Returns the
  // factor between current and usual lengths once it has lasted for some time.
  std::optional<double> update(double stamp_s, double step, double depth);
  // The usual lengths are learned again: another map, or a loop that changed its scale.
  void reset();

 private:
  struct Sample {
    double stamp_s = 0.0;
    double speed = 0.0;  // per second
    double depth = 0.0;
  };
  void learn(const Sample& now);
  std::optional<double> change(const Sample& now) const;

  double max_change_ = 0.0;
  std::optional<double> last_stamp_s_;
  std::optional<double> changed_since_s_;
  std::deque<Sample> window_;
  LogMedian usual_speed_;
  LogMedian usual_depth_;
};

// Consecutive frames whose scale is suspected to have drifted.
struct ScaleDriftInterval {
  core::FrameId first;
  core::FrameId last;
  double factor = 1.0;  // current to usual lengths, the value farthest from 1
};

// Extends the last interval by a frame that follows it, or adds an interval.
void add_to_intervals(std::vector<ScaleDriftInterval>& intervals, core::FrameId frame,
                      double factor);

}  // namespace samewhere::track
