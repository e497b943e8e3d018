#pragma once

#include <optional>

#include <samewhere/features/config.hpp>
#include <samewhere/features/features.hpp>

namespace samewhere::verify {

// Counts views by what they show, not by how fast the camera takes pictures: a frame that shares
// more than a share of its features with the last view counted is still that view. A camera that
// stands still sees one view.
class ViewCounter {
 public:
  // A frame is the same view if at least max_shared of its features match.
  ViewCounter(const features::Config& features, double max_shared)
      : features_(features), max_shared_(max_shared) {}

  // The number of the view that this frame belongs to, from 0 on. A frame without features is of
  // the view before it.
  int count(const features::View& frame);

 private:
  features::Config features_;
  double max_shared_;
  std::optional<features::View> counted_;
  int num_counted_ = 0;
};

}  // namespace samewhere::verify
