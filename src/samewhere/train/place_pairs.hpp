#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <samewhere/core/random.hpp>
#include <samewhere/train/image_set.hpp>

namespace samewhere::train {

// Which views show the same place and which surely do not: what the contrastive loss is taught.
class PlacePairs {
 public:
  // With `has_frame_pairs` another frame may be the second view of a pair, else only the view
  // itself. `images` must outlive it.
  PlacePairs(const ImageSet& images, const Split& split, bool has_frame_pairs);

  // A view of the same place: where the source's places are known, any of its views that show the
  // same place and are used alike (training or validation), itself among them, each as likely;
  // else the view itself.
  int partner(int view, core::Random& random) const;

  // Whether two views surely show different places: by the places of their source; else more than
  // 8 apart in its order; always if they are of two sources.
  bool are_other_places(int a, int b) const;

  // of[i * n + j] = 1: neither view of pair i shows the place of a view of pair j. Pair i consists
  // of `views[i]` and `partners[i]`.
  std::vector<std::uint8_t> other_places(std::span<const int> views,
                                         std::span<const int> partners) const;

 private:
  const ImageSet& images_;
  std::vector<std::vector<int>> same_place_;  // of each view; of some nothing but itself
};

}  // namespace samewhere::train
