#include <algorithm>
#include <cmath>
#include <vector>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/median.hpp>
#include <samewhere/track/scale_drift_detector.hpp>

namespace samewhere::track {
namespace {

constexpr double kMiddle = 512.0;  // bin of 1
constexpr double kStep = 0.05;     // of the logarithm
constexpr double kWindow_s = 2.0;  // its medians are compared with the usual ones
constexpr double kFullWindow_s = 1.5;
constexpr double kLasting_s = 1.5;
constexpr double kLongestGap_s = 0.5;  // between frames; longer ones give no speed
constexpr int kMinUsual = 50;          // frames
constexpr double kMinFlow_hz = 0.05;   // speed / depth of a moving camera
constexpr double kMaxFlowChange = 3.0;

}  // namespace

void LogMedian::add(double value) {
  const double step = std::floor(std::log(value) / kStep) + kMiddle;
  const auto slot = static_cast<std::size_t>(std::clamp(step, 0.0, kNumSteps - 1.0));
  ++counts_[slot];
  ++size_;
}

double LogMedian::value() const {
  core::require(size_ > 0, "a median needs a value");
  int num_below = 0;
  std::size_t slot = 0;
  while (2 * (num_below + static_cast<int>(counts_[slot])) < size_)
    num_below += static_cast<int>(counts_[slot++]);
  return std::exp((static_cast<double>(slot) + 0.5 - kMiddle) * kStep);
}

void ScaleDriftDetector::reset() { *this = ScaleDriftDetector(max_change_); }

std::optional<double> ScaleDriftDetector::update(double stamp_s, double step, double depth) {
  if (max_change_ <= 1.0) return std::nullopt;
  const double gap_s = last_stamp_s_ ? stamp_s - *last_stamp_s_ : 0.0;
  last_stamp_s_ = stamp_s;
  if (gap_s <= 0.0 || gap_s > kLongestGap_s) {
    window_.clear();
    changed_since_s_.reset();
    return std::nullopt;
  }
  if (step <= 0.0 || depth <= 0.0) return std::nullopt;
  window_.push_back({stamp_s, step / gap_s, depth});
  while (stamp_s - window_.front().stamp_s > kWindow_s) window_.pop_front();
  if (stamp_s - window_.front().stamp_s < kFullWindow_s) return std::nullopt;
  std::vector<double> speeds;
  std::vector<double> depths;
  for (const Sample& seen : window_) {
    speeds.push_back(seen.speed);
    depths.push_back(seen.depth);
  }
  const Sample now{stamp_s, *core::median(std::move(speeds)), *core::median(std::move(depths))};
  const auto factor = change(now);
  learn(now);
  if (!factor) {
    changed_since_s_.reset();
    return std::nullopt;
  }
  if (!changed_since_s_) changed_since_s_ = stamp_s;
  return stamp_s - *changed_since_s_ >= kLasting_s ? factor : std::nullopt;
}

void ScaleDriftDetector::learn(const Sample& now) {
  if (now.speed < kMinFlow_hz * now.depth) return;
  usual_speed_.add(now.speed);
  usual_depth_.add(now.depth);
}

// The smaller of both changes: what both support.
std::optional<double> ScaleDriftDetector::change(const Sample& now) const {
  if (usual_speed_.size() < kMinUsual) return std::nullopt;
  const double by_speed = std::log(now.speed / usual_speed_.value());
  const double by_depth = std::log(now.depth / usual_depth_.value());
  if (std::abs(by_speed - by_depth) > std::log(kMaxFlowChange)) return std::nullopt;
  const double least = std::min(std::abs(by_speed), std::abs(by_depth));
  if (by_speed * by_depth <= 0.0 || least < std::log(max_change_)) return std::nullopt;
  return std::exp(by_speed > 0.0 ? least : -least);
}

void add_to_intervals(std::vector<ScaleDriftInterval>& intervals, core::FrameId frame,
                      double factor) {
  if (intervals.empty() || intervals.back().last.index() + 1 != frame.index())
    intervals.push_back({frame, frame, factor});
  ScaleDriftInterval& interval = intervals.back();
  interval.last = frame;
  if (std::abs(std::log(factor)) > std::abs(std::log(interval.factor))) interval.factor = factor;
}

}  // namespace samewhere::track
