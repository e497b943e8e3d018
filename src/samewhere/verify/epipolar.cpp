#include <cstdint>

#include <samewhere/verify/epipolar.hpp>

namespace samewhere::verify {
namespace {

using features::Match;
using features::View;

void add_pixels(const View& query, const View& match, const Match& pair,
                geometry::PixelPairs& pairs) {
  const auto& first = match.features->undistorted_px[static_cast<std::size_t>(pair.first)];
  const auto& second = query.features->undistorted_px[static_cast<std::size_t>(pair.second)];
  pairs.first_px.push_back(first.cast<double>());
  pairs.second_px.push_back(second.cast<double>());
}

}  // namespace

geometry::PixelPairs pixels_of(const View& query, const View& match,
                               const std::vector<Match>& matches) {
  geometry::PixelPairs pairs;
  for (const Match& pair : matches) add_pixels(query, match, pair, pairs);
  return pairs;
}

core::Random random_of(const core::Candidate& candidate, const MeasureSettings& settings) {
  const std::uint64_t query_seed = core::seed_of(settings.seed, "verify", candidate.query.value());
  return core::Random(core::seed_of(query_seed, "match", candidate.match.value()));
}

std::optional<EpipolarInliers> epipolar_inliers(const View& query, const View& match,
                                                const std::vector<Match>& matches,
                                                const Config& config, core::Random& random) {
  const geometry::PixelPairs pairs = pixels_of(query, match, matches);
  const auto found = geometry::estimate_fundamental(
      pairs, {.max_error_px = config.max_error_px, .max_iterations = config.ransac_iterations},
      random);
  if (!found) return std::nullopt;
  EpipolarInliers inliers{.fundamental = found->model, .matches = {}, .pairs = {}};
  for (const int i : found->inliers) {
    inliers.matches.push_back(matches[static_cast<std::size_t>(i)]);
    add_pixels(query, match, inliers.matches.back(), inliers.pairs);
  }
  return inliers;
}

}  // namespace samewhere::verify
