#pragma once

#include <map>
#include <vector>

#include <samewhere/core/descriptor.hpp>
#include <samewhere/features/features.hpp>
#include <samewhere/verify/view_counter.hpp>

namespace samewhere::verify {

// The number of the view that a frame belongs to, and the first frame of a view.
class NumberedViews {
 public:
  NumberedViews(const features::Config& features, double same_view_ratio)
      : counter_(features, same_view_ratio) {}

  void add(const features::View& frame, const core::Descriptor& descriptor);

  // Throws std::out_of_range for a frame that was not added.
  int number_of(core::FrameId frame) const { return number_of_.at(frame); }
  // The first frame of a view, or nullptr.
  const core::Descriptor* at(int number) const;

 private:
  ViewCounter counter_;
  std::map<core::FrameId, int> number_of_;
  std::vector<core::Descriptor> first_frames_;
};

}  // namespace samewhere::verify
