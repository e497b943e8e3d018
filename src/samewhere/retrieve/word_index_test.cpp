#include <algorithm>

#include <gtest/gtest.h>

#include <samewhere/core/random.hpp>
#include <samewhere/features/grow_vocabulary.hpp>
#include <samewhere/retrieve/word_index.hpp>

namespace samewhere::retrieve {
namespace {

class Words : public testing::Test {
 protected:
  Words() {
    for (int i = 0; i < kinds_.rows; ++i) {
      for (int k = 0; k < kinds_.cols; ++k)
        kinds_.at<std::uint8_t>(i, k) = static_cast<std::uint8_t>(random_.index(256));
    }
    vocabulary_ = std::make_shared<const features::Vocabulary>(
        features::grow_vocabulary({kinds_}, {.branching = 4, .depth = 4}));
  }

  cv::Mat view_of(std::initializer_list<int> kinds) const {
    cv::Mat view(0, kinds_.cols, CV_8U);
    for (const int kind : kinds) view.push_back(kinds_.row(kind));
    return view;
  }

  static int best_of(const std::vector<ScoredPosition>& scored) {
    return std::min_element(scored.begin(), scored.end(), is_better)->position;
  }

  core::Random random_{7};
  cv::Mat kinds_ = cv::Mat(100, features::kDescriptorBytes, CV_8U);
  std::shared_ptr<const features::Vocabulary> vocabulary_;
};

TEST_F(Words, TheViewThatShowsMostOfTheSameIsBest) {
  WordIndex index(vocabulary_);
  index.append(view_of({0, 1, 2, 3, 4}));
  index.append(view_of({10, 11, 12, 13, 14}));
  index.append({});  // a dark view
  index.append(view_of({10, 11, 20, 21, 22}));
  const auto scored = index.search(view_of({11, 12, 13, 14, 30}), 4);
  EXPECT_EQ(best_of(scored), 1);
  ASSERT_EQ(scored.size(), 2U) << "nothing speaks for the others";
  EXPECT_EQ(scored[1].position, 3);
}

TEST_F(Words, OnlyAllowedViewsAreFound) {
  WordIndex index(vocabulary_);
  for (int i = 0; i < 3; ++i) index.append(view_of({5, 6, 7}));
  const auto scored = index.search(view_of({5, 6, 7}), 2);
  ASSERT_EQ(scored.size(), 2U);
  EXPECT_EQ(scored[1].position, 1);
  EXPECT_TRUE(index.search(view_of({5, 6, 7}), 0).empty());
  EXPECT_TRUE(index.search({}, 2).empty());
}

TEST_F(Words, ForgottenViewsAreNotFoundAndPositionsCountFromZeroAgain) {
  WordIndex index(vocabulary_);
  for (int i = 0; i < 3; ++i) index.append(view_of({5, 6, 7}));
  index.forget();
  EXPECT_EQ(index.num_views(), 0);
  EXPECT_TRUE(index.search(view_of({5, 6, 7}), 0).empty());
  index.append(view_of({5, 6, 7}));
  const auto scored = index.search(view_of({5, 6, 7}), 1);
  ASSERT_EQ(scored.size(), 1U);
  EXPECT_EQ(scored[0].position, 0);
}

// Every view of this building has the same door (0, 1, 2): the one poster (50) decides.
TEST_F(Words, WhatEveryPlaceShowsHardlyCounts) {
  WordIndex index(vocabulary_);
  for (int i = 0; i < 2000; ++i) index.append(view_of({0, 1, 2}));
  index.append(view_of({50, 51, 52}));
  EXPECT_EQ(best_of(index.search(view_of({0, 1, 2, 50}), 2001)), 2000);
}

TEST_F(Words, AFeatureVotesOnceForAView) {
  WordIndex index(vocabulary_);
  index.append(view_of({60, 60, 60, 60, 60, 60}));
  index.append(view_of({60, 61, 70, 71, 72, 73}));
  EXPECT_EQ(best_of(index.search(view_of({60, 61}), 2)), 1);
}

}  // namespace
}  // namespace samewhere::retrieve
