#include <samewhere/core/similarity.hpp>
#include <samewhere/verify/neighbours.hpp>

namespace samewhere::verify {

void Neighbours::add(const core::Descriptor& descriptor) {
  units_.emplace(descriptor.frame, descriptor.unit);
}

void Neighbours::record(const core::Candidate& candidate) {
  recorded_.insert({candidate.query, candidate.match});
}

std::optional<core::Candidate> Neighbours::at(const core::Candidate& candidate,
                                              int offset_frames) const {
  const auto there = static_cast<std::int64_t>(candidate.match.index()) + offset_frames;
  const auto newest = static_cast<std::int64_t>(candidate.query.index()) -
                      static_cast<std::int64_t>(window_frames_);
  if (there < 0 || there >= newest) return std::nullopt;
  const core::FrameId match(static_cast<std::uint64_t>(there), candidate.match.session());
  const auto unit = units_.find(match);
  const auto query = units_.find(candidate.query);
  if (unit == units_.end() || query == units_.end()) return std::nullopt;
  if (recorded_.contains({candidate.query, match})) return std::nullopt;
  return core::Candidate{.query = candidate.query,
                         .match = match,
                         .similarity = core::ncc(query->second, unit->second),
                         .origin = core::Origin::kNeighbour};
}

}  // namespace samewhere::verify
