#pragma once

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/random.hpp>
#include <samewhere/train/pair_set.hpp>

namespace samewhere::train {

// Planes of a made-up pair. For tests only. Of one place: both pictures show the same, and all
// features agree. Of two: other pictures, and each shows features that the other lacks.
inline cv::Mat test_planes(int number, bool is_same) {
  using verify::kPairSide_px;
  core::Random random(core::seed_of(7, "test pair", static_cast<std::uint64_t>(number)));
  cv::Mat planes = cv::Mat::zeros(verify::kNumPairPlanes * kPairSide_px, kPairSide_px, CV_32F);
  const auto plane = [&](verify::PairPlane which) {
    const int first = static_cast<int>(which) * kPairSide_px;
    return planes.rowRange(first, first + kPairSide_px);
  };
  plane(verify::PairPlane::kSeenByBoth).setTo(1.0F);
  plane(verify::PairPlane::kAlike).setTo(is_same ? 0.8F : 0.5F);
  const auto spot = [&] {
    return cv::Point(8 + static_cast<int>(random.index(112)),
                     8 + static_cast<int>(random.index(112)));
  };
  const auto draw = [&](verify::PairPlane which, cv::Point at, double level, int radius_px) {
    cv::circle(plane(which), at, radius_px, cv::Scalar(level), cv::FILLED);
  };
  for (int i = 0; i < 30; ++i) {
    const cv::Point here = spot();
    const cv::Point there = is_same ? here : spot();
    const double level = random.uniform(-1.0, 1.0);
    draw(verify::PairPlane::kQuery, here, level, 6);
    draw(verify::PairPlane::kMatch, there, level, 6);
    draw(is_same ? verify::PairPlane::kAgree : verify::PairPlane::kOnlyQueryShows, here, 1.0, 2);
    if (!is_same) draw(verify::PairPlane::kOnlyMatchShows, there, 1.0, 2);
  }
  return planes;
}

// As many pairs of one place as of two, a third of them to validate with.
inline PairSet test_pairs(int num_of_each) {
  PairSet set;
  for (const bool is_held_back : {false, true}) {
    const int count = is_held_back ? num_of_each / 2 : num_of_each;
    for (int i = 0; i < 2 * count; ++i)
      set.pairs.push_back(
          {packed(test_planes(i + (is_held_back ? 1000 : 0), i % 2 == 0)), i % 2 == 0});
    set.sources.push_back(
        {is_held_back ? "other pictures" : "pictures", count, count, is_held_back});
  }
  set.sha256 = "of pairs";
  return set;
}

// A network so small that an epoch takes a moment.
inline PairConfig test_pair_config() {
  return {.epochs = 4, .batch = 8, .learning_rate = 0.01, .threads = 1, .channels = 2};
}

}  // namespace samewhere::train
