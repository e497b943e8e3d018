#pragma once

#include <functional>

#include <samewhere/verify/map_context.hpp>

namespace samewhere::pipeline {

// A made-up map, for tests only: no odometry and no landmarks.
class TestMap final : public verify::WithoutMap {
 public:
  std::function<bool(core::FrameId)> connected = [](core::FrameId /*match*/) { return false; };
  std::function<bool(core::FrameId, core::FrameId)> one_place;  // none: the map has no places
  bool is_every_match_a_place = false;  // of its own, as competing hypotheses

  bool is_connected(core::FrameId match) const override { return connected(match); }
  bool has_places() const override { return one_place != nullptr; }
  bool are_one_place(core::FrameId a, core::FrameId b) const override { return one_place(a, b); }
  std::optional<core::CompetingPlaceEvidence> measure_competing_place(
      const core::LedgerRow& /*row*/, const core::LedgerRow& other) const override {
    if (!is_every_match_a_place) return std::nullopt;
    return core::CompetingPlaceEvidence{.frame = other.candidate.match};
  }
};

}  // namespace samewhere::pipeline
