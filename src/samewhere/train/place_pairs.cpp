#include <cstdlib>

#include <samewhere/train/place_pairs.hpp>

namespace samewhere::train {
namespace {

constexpr int kMaxSamePlace = 8;  // apart in the order of a source whose places are not known

// Views among `views`, all of one use, that show the same place as `view`.
std::vector<int> same_place_among(const ImageSet& images, const std::vector<int>& views, int view) {
  const int source = source_of(images, view);
  const core::PlaceTruthMatrix& places = images.sources[static_cast<std::size_t>(source)].places;
  const int first = first_view_of(images, source);
  std::vector<int> same;
  for (const int other : views) {
    const int index = other - first;
    const bool is_same = index >= 0 && index < places.num_frames &&
                         places.at(view - first, index) == core::PlaceTruth::kSame;
    if (is_same || other == view) same.push_back(other);
  }
  return same;
}

}  // namespace

PlacePairs::PlacePairs(const ImageSet& images, const Split& split, bool has_frame_pairs)
    : images_(images), same_place_(images.views.size()) {
  if (!has_frame_pairs) return;
  for (const std::vector<int>* views : {&split.training, &split.validation}) {
    for (const int view : *views) {
      same_place_[static_cast<std::size_t>(view)] = same_place_among(images, *views, view);
    }
  }
}

int PlacePairs::partner(int view, core::Random& random) const {
  const std::vector<int>& same = same_place_[static_cast<std::size_t>(view)];
  return same.empty() ? view : same[random.index(same.size())];
}

bool PlacePairs::are_other_places(int a, int b) const {
  const int source = source_of(images_, a);
  if (source != source_of(images_, b)) return true;
  const core::PlaceTruthMatrix& places = images_.sources[static_cast<std::size_t>(source)].places;
  if (places.num_frames == 0) return std::abs(a - b) > kMaxSamePlace;
  const int first = first_view_of(images_, source);
  return places.at(a - first, b - first) == core::PlaceTruth::kDifferent;
}

std::vector<std::uint8_t> PlacePairs::other_places(std::span<const int> views,
                                                   std::span<const int> partners) const {
  std::vector<std::uint8_t> of;
  of.reserve(views.size() * views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (std::size_t j = 0; j < views.size(); ++j) {
      const bool are_other = i != j && are_other_places(views[i], views[j]) &&
                             are_other_places(views[i], partners[j]) &&
                             are_other_places(partners[i], views[j]) &&
                             are_other_places(partners[i], partners[j]);
      of.push_back(are_other ? 1 : 0);
    }
  }
  return of;
}

}  // namespace samewhere::train
