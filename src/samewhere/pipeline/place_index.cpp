#include <algorithm>

#include <samewhere/pipeline/place_index.hpp>

namespace samewhere::pipeline {
namespace {

// Empty for a view without features.
cv::Mat orb_of(const features::View& view) {
  return view.features ? view.features->descriptors : cv::Mat();
}

// The best views of the most similar places: num_candidates places found by the global descriptor
// and word_candidates by visual words, each with views_per_place views. `candidates`: most similar
// first.
std::vector<core::Candidate> best_of_places(const std::vector<core::Candidate>& candidates,
                                            const verify::MapContext& map,
                                            const retrieve::Config& config) {
  std::vector<core::Candidate> firsts;  // of each place
  std::vector<int> num_views;
  std::vector<core::Candidate> best;
  int num_by_descriptor = config.num_candidates;
  int num_by_words = config.word_candidates;
  for (const core::Candidate& next : candidates) {
    const auto place = std::ranges::find_if(firsts, [&](const core::Candidate& first) {
      return map.are_one_place(first.match, next.match);
    });
    const auto index = static_cast<std::size_t>(place - firsts.begin());
    if (place == firsts.end()) {
      int& num_left = next.origin == core::Origin::kVisualWords ? num_by_words : num_by_descriptor;
      if (num_left == 0) continue;
      --num_left;
      firsts.push_back(next);
      num_views.push_back(0);
    }
    if (num_views[index]++ < config.views_per_place) best.push_back(next);
  }
  return best;
}

}  // namespace

PlaceIndex::PlaceIndex(const Config& config)
    : describer_(describe::make_describer(config.describe)),
      config_(config.retrieve),
      retriever_(config.retrieve, static_cast<std::uint64_t>(config.seed)) {}

core::Descriptor PlaceIndex::describe(core::FrameId frame, const cv::Mat& image) const {
  return describer_->describe(frame, image);
}

void PlaceIndex::remember(const core::Descriptor& descriptor, const features::View& view) {
  retriever_.add(descriptor, orb_of(view));
}

std::vector<retrieve::FoundView> PlaceIndex::search(const core::Descriptor& descriptor,
                                                    const features::View& view) {
  std::vector<retrieve::FoundView> found = retriever_.search(descriptor, orb_of(view));
  remember(descriptor, view);
  return found;
}

std::vector<core::Candidate> PlaceIndex::retrieve(const core::Descriptor& descriptor,
                                                  const features::View& view,
                                                  const verify::MapContext& map) {
  const bool has_places = map.has_places() && config_.shortlist > 0;
  auto candidates =
      retrieve::compare(descriptor, has_places ? retriever_.shortlist(descriptor, orb_of(view))
                                               : retriever_.search(descriptor, orb_of(view)));
  remember(descriptor, view);
  std::erase_if(candidates, [&](const core::Candidate& c) { return map.is_connected(c.match); });
  return has_places ? best_of_places(candidates, map, config_) : candidates;
}

std::vector<core::Candidate> PlaceIndex::retrieve_places(const core::Descriptor& descriptor,
                                                         const features::View& view) const {
  auto candidates =
      retrieve::compare(descriptor, retriever_.search_places(descriptor, orb_of(view)));
  for (core::Candidate& candidate : candidates) candidate.origin = core::Origin::kRelocalization;
  return candidates;
}

}  // namespace samewhere::pipeline
