#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <samewhere/core/descriptor.hpp>
#include <samewhere/core/ledger.hpp>

namespace samewhere::verify {

// Frames near the match of a candidate, for a better match of the same query (docs/decisions/026).
class Neighbours {
 public:
  // Frames younger than the window are none.
  explicit Neighbours(std::uint64_t window_frames) : window_frames_(window_frames) {}

  void add(const core::Descriptor& descriptor);
  // The pair has a verdict: it is no candidate any more.
  void record(const core::Candidate& candidate);

  // The query with the frame at this offset from the match; nothing if there is none, if it is too
  // young, or if the pair has a verdict already.
  std::optional<core::Candidate> at(const core::Candidate& candidate, int offset_frames) const;

 private:
  std::uint64_t window_frames_;
  std::map<core::FrameId, std::vector<float>> units_;
  std::set<std::pair<core::FrameId, core::FrameId>> recorded_;  // query, match
};

}  // namespace samewhere::verify
