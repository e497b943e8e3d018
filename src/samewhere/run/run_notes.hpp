#pragma once

#include <set>
#include <string>
#include <vector>

#include <samewhere/core/ledger.hpp>
#include <samewhere/run/watcher.hpp>

namespace samewhere::run {

// The loops of a run that goes on: those accepted and not withdrawn.
class LoopCount {
 public:
  // Verdicts in the order in which they are told.
  void add(const core::Ledger& rows);
  // "2 loops".
  std::string text() const;

 private:
  std::set<core::CandidateId> accepted_;
};

// What is noted of each frame of a run after it was fed.
class RunNotes {
 public:
  // `watcher`, if any, is told of each frame.
  explicit RunNotes(Watcher* watcher) : watcher_(watcher) {}

  void add(const core::Frame& frame, const pipeline::Slam& slam);
  // Of all frames.
  const std::vector<std::string>& names() const { return names_; }
  // "tracking, 2 loops", for a progress line.
  std::string text() const;

 private:
  Watcher* watcher_;
  std::vector<std::string> names_;
  std::string status_;
  LoopCount loops_;
};

}  // namespace samewhere::run
