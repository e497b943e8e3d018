#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/pipeline/config.hpp>

namespace samewhere::pipeline {
namespace {

TEST(Profiles, PaperDenoisesEqualisesAndStartsFromTheFundamentalMatrix) {
  const Config paper = profile("paper");
  EXPECT_TRUE(paper.features.denoise);
  EXPECT_TRUE(paper.features.equalize);
  EXPECT_EQ(paper.track.initialization.model, track::StartModel::kFundamental);
}

TEST(Profiles, DefaultLooksForCornersInThePictureItselfAndStartsFromTheBetterModel) {
  const Config usual = profile("default");
  EXPECT_FALSE(usual.features.denoise);
  EXPECT_FALSE(usual.features.equalize);
  EXPECT_EQ(usual.track.initialization.model, track::StartModel::kHomographyOrEssential);
}

TEST(Profiles, RecognitionLooksHarderAndElseIsTheDefault) {
  const Config usual = profile("default");
  Config alone = profile("recognition");
  EXPECT_GT(alone.features.num_features, usual.features.num_features);
  EXPECT_GT(alone.retrieve.word_candidates, 0);
  EXPECT_GT(alone.verify.neighbour_frames, 0);
  EXPECT_EQ(usual.verify.neighbour_frames, 0);
  EXPECT_GT(alone.verify.min_inliers_in_sequence, usual.verify.min_inliers_in_sequence)
      << "the more features, the more agree by chance";
  EXPECT_GT(alone.verify.min_inliers, alone.verify.min_inliers_in_sequence);
}

TEST(Profiles, UsualAsksNeitherOdometryNorCompetingPlacesAndTrustsEachLoop) {
  const Config usual = profile("usual");
  EXPECT_EQ(usual.verify.prior, verify::Prior::kUnique);
  EXPECT_EQ(usual.verify.min_inliers, 12);
  EXPECT_GT(usual.retrieve.word_candidates, 0);
  EXPECT_GE(usual.verify.max_odometry_chi_square, 1e9);
  EXPECT_GE(usual.verify.max_competing_chi_square, 1e9);
  EXPECT_GE(usual.verify.max_competing_place_ratio, 1e9);
  EXPECT_EQ(usual.optimize.loop_loss, optimize::LoopLoss::kLeastSquares);
}

TEST(Profiles, AnUnknownOneIsRefusedWithTheNamesOfAll) {
  try {
    profile("recognise");
    FAIL();
  } catch (const core::InputError& error) {
    EXPECT_STREQ(error.what(),
                 "unknown profile recognise; expected one of: default, recognition, paper, usual");
  }
}

}  // namespace
}  // namespace samewhere::pipeline
