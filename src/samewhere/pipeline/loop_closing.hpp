#pragma once

#include <samewhere/core/timing.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/pipeline/loop_detector.hpp>
#include <samewhere/pipeline/map_context.hpp>
#include <samewhere/pipeline/messages.hpp>
#include <samewhere/scene/map_file.hpp>

namespace samewhere::pipeline {

// The verdict on an accepted loop in a later map version, with the loops that were closed since.
// `odometry` follows the map from here on.
core::Verdict reverify(const scene::MapVersion& map, verify::OdometryTree& odometry,
                       const scene::LoopEdge& loop, const core::LedgerRow& accepted,
                       const Config& config);

// The third stage: detects the loops of a keyframe and the places of a LOST view. Owns the place
// index and the ledger.
class LoopClosing {
 public:
  explicit LoopClosing(const Config& config);
  // Remembers the views of a known map.
  LoopClosing(const Config& config, const scene::StoredMap& known);

  // One answer to each message.
  LoopAnswer answer(const ToLoopClosing& message);

  const core::Ledger& ledger() const { return ledger_; }
  const PlaceIndex& index() const { return detector_.index(); }
  const core::Timings& timings() const { return timings_; }

 private:
  LoopAnswer answer(const FindLoops& question);
  // The places of the whole map that the view may show.
  LoopAnswer answer(const FindPlace& question);
  LoopAnswer answer(const AskAgain& question);

  Config config_;
  core::Timings timings_;
  LoopDetector detector_;
  core::Ledger ledger_;
  KeyframeOf keyframe_of_;         // of the remembered views
  verify::OdometryTree odometry_;  // of the map of the last question
};

}  // namespace samewhere::pipeline
