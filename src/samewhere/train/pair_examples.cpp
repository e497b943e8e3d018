#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <opencv2/imgproc.hpp>

#include <samewhere/train/pair_examples.hpp>
#include <samewhere/verify/pair_view.hpp>

namespace samewhere::train {
namespace {

using verify::kNumPairPlanes;
using verify::kPairSide_px;
using verify::PairPlane;

constexpr double kSwapped = 0.5;
constexpr double kMirrored = 0.5;
constexpr double kMaxViewShift_px = 10.0;
constexpr double kMaxViewTurn_rad = 8.0 * std::numbers::pi / 180.0;
constexpr double kMaxViewLogScale = 0.2;
constexpr double kMisregisteredSigma_px = 3.0;
constexpr double kMisregisteredTurnSigma_rad = 2.5 * std::numbers::pi / 180.0;
constexpr double kMisregisteredLogScaleSigma = 0.05;
constexpr double kMaxLogContrast = 0.4;
constexpr double kMaxBlur_px = 1.2;
constexpr double kMaxNoiseSigma = 0.15;
constexpr double kLeastLikeness = 0.4;  // of what it was
constexpr double kMaxMissedMatches = 0.4;
constexpr double kMaxMissedDifferences = 0.3;
constexpr int kMissedCell_px = 5;  // about the size of a dot

using Planes = std::array<cv::Mat, kNumPairPlanes>;

Planes apart(const cv::Mat& stack) {
  Planes planes;
  for (int i = 0; i < kNumPairPlanes; ++i)
    planes[static_cast<std::size_t>(i)] =
        stack.rowRange(i * kPairSide_px, (i + 1) * kPairSide_px).clone();
  return planes;
}

cv::Mat& at(Planes& planes, PairPlane plane) { return planes[static_cast<std::size_t>(plane)]; }

// A similarity about the middle, as OpenCV has it: 2 x 3.
cv::Mat similarity(double turn_rad, double scale, double x_px, double y_px) {
  const cv::Point2f middle(0.5F * kPairSide_px, 0.5F * kPairSide_px);
  cv::Mat map = cv::getRotationMatrix2D(middle, turn_rad * 180.0 / std::numbers::pi, scale);
  map.at<double>(0, 2) += x_px;
  map.at<double>(1, 2) += y_px;
  return map;
}

void move(const cv::Mat& map, cv::Mat& plane) {
  cv::Mat moved;
  cv::warpAffine(plane, moved, map, plane.size(), cv::INTER_LINEAR);
  plane = moved;
}

void see_from_elsewhere(core::Random& random, Planes& planes) {
  const double turn_rad = random.uniform(-kMaxViewTurn_rad, kMaxViewTurn_rad);
  const double scale = std::exp(random.uniform(-kMaxViewLogScale, kMaxViewLogScale));
  const double x_px = random.uniform(-kMaxViewShift_px, kMaxViewShift_px);
  const double y_px = random.uniform(-kMaxViewShift_px, kMaxViewShift_px);
  const cv::Mat map = similarity(turn_rad, scale, x_px, y_px);
  for (cv::Mat& plane : planes) move(map, plane);
}

// The match beside where it should be.
void misregister(core::Random& random, Planes& planes) {
  const double turn_rad = kMisregisteredTurnSigma_rad * random.gaussian();
  const double scale = std::exp(kMisregisteredLogScaleSigma * random.gaussian());
  const double x_px = kMisregisteredSigma_px * random.gaussian();
  const double y_px = kMisregisteredSigma_px * random.gaussian();
  const cv::Mat map = similarity(turn_rad, scale, x_px, y_px);
  move(map, at(planes, PairPlane::kMatch));
  move(map, at(planes, PairPlane::kOnlyMatchShows));
}

void photograph_again(core::Random& random, cv::Mat& picture) {
  const double contrast = std::exp(random.uniform(-kMaxLogContrast, kMaxLogContrast));
  const double blur_px = random.uniform(0.0, kMaxBlur_px);
  const auto sigma = static_cast<float>(random.uniform(0.0, kMaxNoiseSigma));
  if (blur_px > 0.3) cv::GaussianBlur(picture, picture, {}, blur_px);
  picture *= contrast;
  for (int row = 0; row < picture.rows; ++row) {
    auto* pixels = picture.ptr<float>(row);
    for (int column = 0; column < picture.cols; ++column) {
      // of four uniform numbers: near enough to normal, and much cheaper
      const std::uint64_t bits = random.next();
      const auto sum = static_cast<float>((bits & 0xffffU) + ((bits >> 16) & 0xffffU) +
                                          ((bits >> 32) & 0xffffU) + (bits >> 48));
      const float normal = (sum / 65536.0F - 2.0F) * 1.732F;
      pixels[column] = std::clamp(pixels[column] + sigma * normal, -1.0F, 1.0F);
    }
  }
}

// Of each cell that holds dots, all are missed or none.
void miss(double share, core::Random& random, cv::Mat& plane) {
  for (int row = 0; row < plane.rows; row += kMissedCell_px) {
    for (int column = 0; column < plane.cols; column += kMissedCell_px) {
      if (random.uniform() >= share) continue;
      const cv::Rect cell(column, row, std::min(kMissedCell_px, plane.cols - column),
                          std::min(kMissedCell_px, plane.rows - row));
      plane(cell) = 0.0F;
    }
  }
}

// Nothing of what either view shows in some cells of the planes is known.
void hide_features(double share, core::Random& random, Planes& planes) {
  const std::uint64_t seed = random.next();
  for (const PairPlane features :
       {PairPlane::kAgree, PairPlane::kOnlyQueryShows, PairPlane::kOnlyMatchShows}) {
    core::Random same_cells(seed);
    miss(share, same_cells, at(planes, features));
  }
}

void swap_views(Planes& planes) {
  std::swap(at(planes, PairPlane::kQuery), at(planes, PairPlane::kMatch));
  std::swap(at(planes, PairPlane::kOnlyQueryShows), at(planes, PairPlane::kOnlyMatchShows));
}

void append(const cv::Mat& planes, std::vector<float>& numbers) {
  numbers.insert(numbers.end(), planes.begin<float>(), planes.end<float>());
}

// Both kinds weigh half of `indices` each.
void balance(std::span<const PairExample> pairs, const std::vector<int>& indices,
             std::vector<float>& weights) {
  double of_same = 0.0;
  double of_wrong = 0.0;
  for (const int i : indices) {
    const auto index = static_cast<std::size_t>(i);
    (pairs[index].is_same ? of_same : of_wrong) += weights[index];
  }
  const double half = 0.5 * static_cast<double>(indices.size());
  for (const int i : indices) {
    const auto index = static_cast<std::size_t>(i);
    weights[index] *= static_cast<float>(half / (pairs[index].is_same ? of_same : of_wrong));
  }
}

}  // namespace

cv::Mat distorted_pair(const cv::Mat& stack, const PairConfig& config, core::Random& random) {
  Planes planes = apart(stack);
  if (random.uniform() < kSwapped) swap_views(planes);
  if (random.uniform() < kMirrored) {
    for (cv::Mat& plane : planes) cv::flip(plane, plane, 1);
  }
  see_from_elsewhere(random, planes);
  misregister(random, planes);
  const bool is_hidden = random.uniform() < config.hidden_pictures;
  for (const PairPlane picture : {PairPlane::kQuery, PairPlane::kMatch}) {
    cv::Mat& plane = at(planes, picture);
    if (is_hidden) {
      plane = 0.0F;
    } else {
      photograph_again(random, plane);
    }
    plane = plane.mul(at(planes, PairPlane::kSeenByBoth));
  }
  // another view of one place differs as another place does: how much is not to decide
  at(planes, PairPlane::kAlike) *= is_hidden ? 0.0 : random.uniform(kLeastLikeness, 1.0);
  miss(random.uniform(0.0, kMaxMissedMatches), random, at(planes, PairPlane::kAgree));
  const double missed_ratio = random.uniform(0.0, kMaxMissedDifferences);
  miss(missed_ratio, random, at(planes, PairPlane::kOnlyQueryShows));
  miss(missed_ratio, random, at(planes, PairPlane::kOnlyMatchShows));
  hide_features(random.uniform(0.0, config.hidden_features), random, planes);
  cv::Mat distorted;
  cv::vconcat(planes.data(), planes.size(), distorted);
  return distorted;
}

std::vector<float> weights_of(const PairSet& set) {
  constexpr double kSmoothing = 10.0;  // pairs: a source with few of a kind is not all that kind
  std::vector<float> weights;
  for (const PairSource& source : set.sources) {
    const double half = 0.5 * (source.num_same + source.num_wrong) + kSmoothing;
    for (int i = 0; i < source.num_same + source.num_wrong; ++i) {
      const bool is_same = set.pairs[weights.size()].is_same;
      const int num_of_kind = is_same ? source.num_same : source.num_wrong;
      weights.push_back(static_cast<float>(half / (num_of_kind + kSmoothing)));
    }
  }
  for (const bool is_held_back : {false, true})
    balance(set.pairs, pairs_of(set, is_held_back), weights);
  return weights;
}

void PairExampleMaker::add(int index, const cv::Mat& planes, PairBatch& batch) const {
  ++batch.num_examples;
  append(planes, batch.planes);
  batch.is_same.push_back(pairs_[static_cast<std::size_t>(index)].is_same ? 1.0F : 0.0F);
  batch.weights.push_back(weights_[static_cast<std::size_t>(index)]);
}

PairBatch PairExampleMaker::distorted(std::span<const int> indices, std::uint64_t seed) const {
  PairBatch batch;
  for (const int index : indices) {
    const PairExample& pair = pairs_[static_cast<std::size_t>(index)];
    core::Random random(core::seed_of(seed, "distort", static_cast<std::uint64_t>(index)));
    add(index, distorted_pair(unpacked(pair.planes), config_, random), batch);
  }
  return batch;
}

PairBatch PairExampleMaker::plain(std::span<const int> indices) const {
  PairBatch batch;
  for (const int index : indices) {
    const PairExample& pair = pairs_[static_cast<std::size_t>(index)];
    add(index, unpacked(pair.planes), batch);
  }
  return batch;
}

}  // namespace samewhere::train
