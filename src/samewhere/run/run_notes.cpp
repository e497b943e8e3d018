#include <fmt/format.h>

#include <samewhere/run/run_notes.hpp>

namespace samewhere::run {

void LoopCount::add(const core::Ledger& rows) {
  for (const core::LedgerRow& row : rows) {
    if (row.candidate.origin == core::Origin::kRelocalization) continue;
    if (core::is_loop(row.verdict))
      accepted_.insert(row.candidate.id);
    else
      accepted_.erase(row.candidate.id);
  }
}

std::string LoopCount::text() const {
  return fmt::format("{} loop{}", accepted_.size(), accepted_.size() == 1 ? "" : "s");
}

void RunNotes::add(const core::Frame& frame, const pipeline::Slam& slam) {
  names_.push_back(frame.name);
  loops_.add(slam.newest_rows());
  status_ = core::name_of(slam.frames().back().status);
  if (watcher_ != nullptr) watcher_->see_frame(frame, slam);
}

std::string RunNotes::text() const { return fmt::format("{}, {}", status_, loops_.text()); }

}  // namespace samewhere::run
