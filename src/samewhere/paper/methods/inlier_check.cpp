#include <vector>

#include <samewhere/core/random.hpp>
#include <samewhere/features/match_pair.hpp>
#include <samewhere/geometry/two_view.hpp>
#include <samewhere/paper/methods/inlier_check.hpp>

namespace samewhere::paper {

int count_inliers(const features::View& query, const features::View& match,
                  const InlierCheck& check) {
  const std::vector<features::Match> matches = features::match_pair(
      match.features->descriptors, query.features->descriptors, check.features);
  if (static_cast<int>(matches.size()) < check.min_matches) return 0;
  geometry::PixelPairs pairs;
  for (const features::Match& pair : matches) {
    pairs.first_px.push_back(
        match.features->undistorted_px[static_cast<std::size_t>(pair.first)].cast<double>());
    pairs.second_px.push_back(
        query.features->undistorted_px[static_cast<std::size_t>(pair.second)].cast<double>());
  }
  const std::uint64_t query_seed = core::seed_of(check.seed, "method", query.frame.value());
  core::Random random(core::seed_of(query_seed, "match", match.frame.value()));
  const auto found = geometry::estimate_fundamental(
      pairs, {.max_error_px = check.max_error_px, .max_iterations = check.max_iterations}, random);
  return found ? static_cast<int>(found->inliers.size()) : 0;
}

}  // namespace samewhere::paper
