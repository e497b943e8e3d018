#include <samewhere/core/match_from_query.hpp>

namespace samewhere::core {

std::optional<Sim3> match_from_query_of(const Verdict& verdict) {
  std::optional<Sim3> match_from_query;
  if (const auto* loop = std::get_if<LoopClosure>(&verdict))
    match_from_query = loop->match_from_query;
  else if (evidence_of(verdict).geometry)
    match_from_query = evidence_of(verdict).geometry->match_from_query;
  if (match_from_query && !is_finite(rigid_part(*match_from_query))) return std::nullopt;
  return match_from_query;
}

}  // namespace samewhere::core
