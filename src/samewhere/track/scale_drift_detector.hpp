#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include <samewhere/core/ids.hpp>

namespace samewhere::track {

// Of positive values, where half of them lie below: counted in steps of 5 %, in constant memory.
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

// Notices that the scale of a map without depth has changed. No single view shows it; but then the
// camera moves, and the landmarks in sight lie, so many times slower and nearer than ever before,
// and the view flows by as it always did. A camera that stands still, or stands before a wall,
// shows only one of these. One that is moved slowly close to things for long shows the same as a
// changed scale: what is found is a suspicion. Lengths are in map units.
class ScaleWatch {
 public:
  // `max_change`: how many times smaller or larger is a change; 1 or less: nothing is noticed.
  explicit ScaleWatch(double max_change) : max_change_(max_change) {}

  // A frame: how far the camera moved since the frame before, and the median depth of what it sees.
  // Gives by what factor lengths differ from the usual ones, once that has lasted.
  std::optional<double> see(double stamp_s, double step, double depth);
  // Lengths begin anew: another map, or a loop that has changed them.
  void forget();

 private:
  struct Seen {
    double stamp_s = 0.0;
    double speed = 0.0;  // per second
    double depth = 0.0;
  };
  void learn(const Seen& now);
  std::optional<double> change(const Seen& now) const;

  double max_change_ = 0.0;
  std::optional<double> last_stamp_s_;
  std::optional<double> changed_since_s_;
  std::deque<Seen> window_;
  LogMedian usual_speed_;
  LogMedian usual_depth_;
};

// Frames in a row whose scale is suspected to have changed.
struct ScaleDoubt {
  core::FrameId first;
  core::FrameId last;
  double factor = 1.0;  // of lengths, against the usual ones, where it was farthest from 1
};

// Adds a frame to the last row of them, if it goes on there, or begins another.
void note_doubt(std::vector<ScaleDoubt>& doubts, core::FrameId frame, double factor);

}  // namespace samewhere::track
