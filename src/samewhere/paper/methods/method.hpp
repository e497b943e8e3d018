#pragma once

#include <vector>

#include <samewhere/core/frame.hpp>
#include <samewhere/evaluate/precision_recall.hpp>

namespace samewhere::paper {

// What a method says of a sequence, by 0-based positions of frames.
struct Findings {
  // The best match of each query that has one, accepted or not, with its score: what
  // precision and recall are of.
  std::vector<evaluate::Match> matches;
  // Those that the method takes for loops, with its own threshold and its own pauses.
  std::vector<evaluate::Match> accepted;
};

// A loop detector that looks at images one after another. The published method and descriptors in
// its place are none of these: their search is repeated with many seeds (runs.hpp).
class Method {
 public:
  Method() = default;
  Method(const Method&) = delete;
  Method& operator=(const Method&) = delete;
  virtual ~Method() = default;

  // Frames come in order, numbered from 0. A caller that measures time calls this, and nothing
  // else, within it. One thread.
  virtual void see(const core::Frame& frame) = 0;
  // Once, after the last frame.
  virtual Findings findings() = 0;
};

}  // namespace samewhere::paper
