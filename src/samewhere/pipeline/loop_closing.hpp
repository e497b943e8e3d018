#pragma once

#include <map>
#include <set>

#include <samewhere/core/timing.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/pipeline/loop_detector.hpp>
#include <samewhere/pipeline/messages.hpp>
#include <samewhere/scene/map_file.hpp>

namespace samewhere::pipeline {

// Which keyframes frames are.
using KeyframeOf = std::map<core::FrameId, core::KeyframeId>;

// The verdict on a loop, accepted once, on a map that by now believes others.
core::Verdict verdict_on(const scene::MapVersion& map, const scene::LoopEdge& loop,
                         const core::LedgerRow& accepted, const Config& config);

// The third stage: have I been here before, and is it really the same place? Owns the place index
// and the ledger.
class LoopClosing {
 public:
  explicit LoopClosing(const Config& config);
  // Remembers the views of a known map.
  LoopClosing(const Config& config, const scene::StoredMap& known);

  // One answer to each message.
  LoopAnswer answer(const ToLoopClosing& message);

  const core::Ledger& ledger() const { return ledger_; }
  const LoopDetector& detector() const { return detector_; }
  const core::Timings& timings() const { return timings_; }

 private:
  LoopAnswer answer(const FindLoops& question);
  // Which places of the whole map may this be? The judge of loops says what it recognises.
  LoopAnswer answer(const FindPlace& question);

  Config config_;
  core::Timings timings_;
  LoopDetector detector_;
  core::Ledger ledger_;
  KeyframeOf keyframe_of_;  // of views that are remembered
};

}  // namespace samewhere::pipeline
