#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include <samewhere/pipeline/place_evidence.hpp>

namespace samewhere::pipeline {
namespace {

// Found ratio, over that of mapping: at the place itself, and once the camera has left a
// look-alike.
constexpr double kHere = 1.05;
constexpr double kHereSigma = 0.13;
constexpr double kLeft = 0.1;
constexpr double kLeftSigma = 0.15;
// Uniform up to the ratio of the place: of look-alikes that differ, and of a place that has
// changed.
constexpr double kLeastDiffering = 0.4;
constexpr double kLeastSigma = 0.1;
constexpr double kDiffering = 1.0 / (kHere - kLeastDiffering);
constexpr double kShareOfChanged = 0.2;  // of places
// Of a view: that from here on the place differs more, or less, than it did.
constexpr double kChanges = 0.02;
// Of a view in the mean of the found ratio, one view later.
constexpr double kRemembers = 0.92;
// Density of any ratio, whatever the place: people, blur, the end of the map.
constexpr double kOutlier = 0.05;
// Share of new landmarks from which a metre counts in full.
constexpr double kNewRatio = 0.2;
// Of places, around the mean.
constexpr double kPlaceSigma = 0.07;
// With fewer inliers a place is no look-alike: it shares some objects. Those leave the view; what
// explains a part of it for longer is a look-alike that differs more.
constexpr double kLookAlikeRatio = 0.4;
constexpr double kDifferentLookAlikeRatio = 0.2;
constexpr int kViewsOfDifferent = 8;
constexpr double kMaxByLookAlike = 6.0;

double normal(double x, double mean, double sigma) {
  const double z = (x - mean) / sigma;
  return std::exp(-0.5 * z * z) / (sigma * std::sqrt(2.0 * std::numbers::pi));
}

// Of a mean that is anywhere between the two.
double normal_between(double x, double from, double to, double sigma) {
  if (to - from < 0.01 * sigma) return normal(x, to, sigma);
  const auto share_below = [&](double limit) {
    return 0.5 * std::erfc((x - limit) / (sigma * std::numbers::sqrt2));
  };
  return (share_below(to) - share_below(from)) / (to - from);
}

double density_here(double ratio) {
  return normal(std::min(ratio, kHere), kHere, kHereSigma) + kOutlier;
}

double density_differing(double ratio) {
  const double below = std::min(ratio - kLeastDiffering, 0.0) / kLeastSigma;
  return kDiffering * std::exp(-0.5 * below * below) + kOutlier;
}

void mix(double& a, double& b) {
  const double moved = kChanges * (a - b);
  a -= moved;
  b += moved;
}

double density_left(double ratio) {
  return normal(std::max(ratio, kLeft), kLeft, kLeftSigma) + kOutlier;
}

}  // namespace

double NewGround::add(const Eigen::Vector3d& position, double moved_m) {
  constexpr double kSpacing_m = 1.0;
  constexpr double kNear_m = 1.5;
  constexpr std::ptrdiff_t kNewest = 3;  // the camera has just been there
  const auto is_near = [&](const Eigen::Vector3d& earlier) {
    return (position - earlier).norm() < kNear_m;
  };
  const auto end = path_.end() - std::min(kNewest, std::ssize(path_));
  const bool is_new = std::none_of(path_.begin(), end, is_near);
  if (path_.empty() || (position - path_.back()).norm() >= kSpacing_m) path_.push_back(position);
  return is_new ? moved_m : 0.0;
}

void PlaceEvidence::add(const PlaceView& view) {
  const double weight = view.new_ratio;
  const auto likelihood = [&](double density) { return std::pow(density, weight); };
  const double same = likelihood(density_here(view.found_ratio));
  const double differing = likelihood(density_differing(view.found_ratio));
  const double new_m = view.moved_m * std::min(1.0, view.new_ratio / kNewRatio);
  const double leaves = 1.0 - std::exp(-new_m / common_length_m_);

  mix(here_.as_mapped, here_.changed);
  mix(lookalike_.same, lookalike_.differing);
  here_ = {here_.as_mapped * same, here_.changed * differing};
  const double in_common = lookalike_.same + lookalike_.differing;
  lookalike_ = {
      (1.0 - leaves) * lookalike_.same * same, (1.0 - leaves) * lookalike_.differing * differing,
      (lookalike_.left + leaves * in_common) * likelihood(density_left(view.found_ratio))};
  const double of_here = here_.as_mapped + here_.changed;
  const double of_lookalike = lookalike_.same + lookalike_.differing + lookalike_.left;
  log_ratio_ += std::log(of_here / of_lookalike);
  here_ = {here_.as_mapped / of_here, here_.changed / of_here};
  lookalike_ = {lookalike_.same / of_lookalike, lookalike_.differing / of_lookalike,
                lookalike_.left / of_lookalike};
  found_ = kRemembers * found_ + weight * std::min(view.found_ratio, kHere);
  weight_ = kRemembers * weight_ + weight;
}

bool is_lookalike(double other_ratio, int num_views) {
  return other_ratio >=
         (num_views < kViewsOfDifferent ? kLookAlikeRatio : kDifferentLookAlikeRatio);
}

double log_ratio_by_lookalike(double found_ratio, double other_ratio, double num_views) {
  if (num_views <= 0.0) return 0.0;
  const double sigma = std::hypot(kHereSigma / std::sqrt(num_views), kPlaceSigma);
  const double found = std::min(found_ratio, kHere);
  const double here = (1.0 - kShareOfChanged) * normal(found, kHere, sigma) +
                      kShareOfChanged * normal_between(found, kLeastDiffering, kHere, sigma);
  const double expected = std::min(other_ratio, 1.0) * kHere;
  const double alike = normal(std::max(found, expected), expected, sigma);
  const double closer = normal_between(std::max(found, expected), expected, kHere, sigma);
  const double lookalike = (1.0 - kShareOfCloser) * alike + kShareOfCloser * closer;
  return std::clamp(std::log(here / lookalike), -kMaxByLookAlike, kMaxByLookAlike);
}

}  // namespace samewhere::pipeline
