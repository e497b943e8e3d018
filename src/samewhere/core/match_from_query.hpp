#pragma once

#include <optional>

#include <samewhere/core/verdict.hpp>

namespace samewhere::core {

// The relative pose of a verdict, body of the match from body of the query: of a loop its own, of a
// rejected or ambiguous candidate that of its geometry. Nothing without a pose, or where it is not
// finite.
std::optional<Sim3> match_from_query_of(const Verdict& verdict);

}  // namespace samewhere::core
