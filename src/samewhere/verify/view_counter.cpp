#include <algorithm>

#include <samewhere/features/match_pair.hpp>
#include <samewhere/verify/view_counter.hpp>

namespace samewhere::verify {
namespace {

constexpr int kMinFeatures = 50;

double shared_ratio(const features::View& a, const features::View& b,
                    const features::Config& config) {
  const auto matches = match_pair(a.features->descriptors, b.features->descriptors, config);
  return static_cast<double>(matches.size()) / std::min(a.features->size(), b.features->size());
}

}  // namespace

int ViewCounter::count(const features::View& frame) {
  if (frame.features->size() >= kMinFeatures &&
      (!counted_ || shared_ratio(*counted_, frame, features_) < max_shared_)) {
    counted_ = frame;
    ++num_counted_;
  }
  return std::max(0, num_counted_ - 1);
}

}  // namespace samewhere::verify
