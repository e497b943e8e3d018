#include <gtest/gtest.h>

#include <samewhere/pipeline/config.hpp>

namespace samewhere::pipeline {
namespace {

TEST(Profiles, PaperDenoisesEqualisesAndStartsFromTheFundamentalMatrix) {
  const Config paper = profile("paper");
  EXPECT_TRUE(paper.features.denoise);
  EXPECT_TRUE(paper.features.equalize);
  EXPECT_EQ(paper.track.start.model, track::StartModel::kFundamental);
}

TEST(Profiles, DefaultLooksForCornersInThePictureItselfAndStartsFromTheBetterModel) {
  const Config usual = profile("default");
  EXPECT_FALSE(usual.features.denoise);
  EXPECT_FALSE(usual.features.equalize);
  EXPECT_EQ(usual.track.start.model, track::StartModel::kHomographyOrEssential);
}

}  // namespace
}  // namespace samewhere::pipeline
