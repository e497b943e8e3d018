#include <algorithm>
#include <cmath>
#include <utility>

#include <samewhere/pipeline/place_differences.hpp>
#include <samewhere/pipeline/place_evidence.hpp>

namespace samewhere::pipeline {
namespace {

// Of a cell: with fewer landmarks nothing is said.
constexpr int kMinInCell = 10;
// Inliers per visible landmark of an object that is there, and of one that is not.
constexpr double kFoundRatio = 0.5;
constexpr double kNotFoundRatio = 0.25;
// Two places are told apart by so many objects, by so large a share of what they show, and by so
// few on the other side.
constexpr double kMinObjects = 3.0;
constexpr double kMinShare = 0.12;
constexpr double kMaxOtherShare = 0.25;
// Of the objects that both places show, as many seem to be of one place alone where the places are
// equal: they were mapped from elsewhere, or are half hidden.
constexpr double kChanceShare = 0.07;
// Of the objects of one place alone: those of this place, if the camera is there, and if it is in a
// third place.
constexpr double kOwnHere = 0.95;
constexpr double kOwnElsewhere = 0.5;
constexpr int kCloserShares = 16;
constexpr double kMaxLogRatio = 6.0;
// Objects of the other place lead to that place; alone they do not take this one back.
constexpr double kMinLogRatio = -1.0;

bool is_found(const Counts& counts) {
  return counts.num_inliers >= kFoundRatio * counts.num_visible;
}

bool is_missing(const Counts& counts) {
  return counts.num_inliers < kNotFoundRatio * counts.num_visible;
}

}  // namespace

// The share of the landmarks that no earlier view has counted.
double PlaceDifferences::count(const std::vector<core::LandmarkId>& inliers) {
  int num_new = 0;
  for (const core::LandmarkId id : inliers) num_new += counted_.insert(id).second ? 1 : 0;
  return static_cast<double>(num_new) / static_cast<double>(inliers.size());
}

void PlaceDifferences::add(const features::View& view, const SeenPlace& here,
                           const SeenPlace& there) {
  const InliersByCell of_here = inliers_by_cell(view, here.pose);
  const InliersByCell of_there = inliers_by_cell(view, there.pose);
  for (std::size_t i = 0; i < of_here.size(); ++i) {
    const Counts& a = here.evidence.cells[i];
    const Counts& b = there.evidence.cells[i];
    if (std::min(a.num_visible, b.num_visible) < kMinInCell) continue;
    if (is_found(a) && is_found(b)) both_ += count(of_here[i]);
    if (is_found(a) && is_missing(b)) only_here_ += count(of_here[i]);
    if (is_missing(a) && is_found(b)) only_there_ += count(of_there[i]);
  }
}

PlaceDifferences PlaceDifferences::swapped() const {
  PlaceDifferences other = *this;
  std::swap(other.only_here_, other.only_there_);
  return other;
}

bool PlaceDifferences::is_shown(double own, double others) const {
  return is_lookalike() && own >= kMinObjects && own >= kMinShare * (own + both_) &&
         others <= kMaxOtherShare * own;
}

double log_ratio_by_objects(double own, double others) {
  const auto likelihood = [&](double share_of_own) {
    return std::pow(share_of_own, own) * std::pow(1.0 - share_of_own, others);
  };
  double closer = 0.0;  // any share between those of the two
  for (int i = 0; i < kCloserShares; ++i)
    closer += likelihood(kOwnElsewhere + (i + 0.5) / kCloserShares * (kOwnHere - kOwnElsewhere));
  const double elsewhere =
      (1.0 - kShareOfCloser) * likelihood(kOwnElsewhere) + kShareOfCloser * closer / kCloserShares;
  return std::clamp(std::log(likelihood(kOwnHere) / elsewhere), kMinLogRatio, kMaxLogRatio);
}

double log_ratio_by_differences(const PlaceDifferences& differences) {
  if (!differences.is_lookalike()) return 0.0;
  const double by_chance = kChanceShare * differences.both();
  return log_ratio_by_objects(std::max(0.0, differences.only_here() - by_chance),
                              std::max(0.0, differences.only_there() - by_chance));
}

}  // namespace samewhere::pipeline
