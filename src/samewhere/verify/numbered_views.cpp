#include <samewhere/verify/numbered_views.hpp>

namespace samewhere::verify {

void NumberedViews::add(const features::View& frame, const core::Descriptor& descriptor) {
  const int number = counter_.count(frame);
  number_of_[frame.frame] = number;
  if (number == static_cast<int>(first_frames_.size())) first_frames_.push_back(descriptor);
}

const core::Descriptor* NumberedViews::at(int number) const {
  const bool is_known = number >= 0 && number < static_cast<int>(first_frames_.size());
  return is_known ? &first_frames_[static_cast<std::size_t>(number)] : nullptr;
}

}  // namespace samewhere::verify
