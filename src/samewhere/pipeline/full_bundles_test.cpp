#include <gtest/gtest.h>

#include <samewhere/map/test_map.hpp>
#include <samewhere/pipeline/full_bundles.hpp>

namespace samewhere::pipeline {
namespace {

// A growing map, whose full bundles begin two keyframes after a correction and are due one later.
class Growing : public testing::Test {
 protected:
  Growing() {
    for (int i = 1; i <= 12; ++i) maps_.push_back(map::test_map(world_, i, 0.01));
  }

  const scene::MapVersion& map_of(std::size_t num_keyframes) const {
    return maps_.at(num_keyframes - 1);
  }

  // As mapping does it with each keyframe: what is due, then maybe a new one.
  bool hears_of_one(std::size_t num_keyframes) {
    const bool is_due = full_bundles_.due(map_of(num_keyframes - 1)).has_value();
    full_bundles_.begin(map_of(num_keyframes));
    return is_due;
  }

  features::TestWorld world_ = features::test_world(4, 1000);
  std::vector<scene::MapVersion> maps_;
  Config config_;
  Bundling bundling_{config_};
  int num_begun_ = 0;
  core::DirectLink<BundleAll, scene::Edit> link_{
      [this](const BundleAll& question, const BundleLink::Reply& reply) {
        ++num_begun_;
        reply(bundling_.answer(question));
      }};
  FullBundles full_bundles_{{.full_bundle_after_keyframes = 2, .full_bundle_pace = 10'000'000},
                            link_};
};

TEST_F(Growing, WithoutACorrectionNothingIsBundled) {
  for (std::size_t i = 2; i <= 12; ++i) EXPECT_FALSE(hears_of_one(i));
  EXPECT_FALSE(full_bundles_.last(map_of(12)));
  EXPECT_EQ(num_begun_, 0);
}

TEST_F(Growing, AfterACorrectionItIsBegunOnceAndCountsWhenItIsDue) {
  full_bundles_.note_correction(map_of(5));
  EXPECT_FALSE(hears_of_one(6));
  EXPECT_EQ(num_begun_, 0);
  EXPECT_FALSE(hears_of_one(7)) << "begun now";
  EXPECT_EQ(num_begun_, 1);
  EXPECT_FALSE(hears_of_one(8)) << "the answer is there, but does not count yet";
  const auto found = full_bundles_.due(map_of(8));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->pose_changes.size(), 7U) << "the eighth with its parent, the first is held";
  EXPECT_EQ(found->settled.size(), 6U);
  for (std::size_t i = 9; i <= 12; ++i) EXPECT_FALSE(hears_of_one(i));
  EXPECT_EQ(num_begun_, 1);
}

TEST_F(Growing, ACorrectionMeanwhileMakesItVoidAndCallsForAnother) {
  full_bundles_.note_correction(map_of(5));
  EXPECT_FALSE(hears_of_one(7));
  full_bundles_.note_correction(map_of(7));
  EXPECT_FALSE(hears_of_one(8));
  EXPECT_FALSE(hears_of_one(9)) << "the first, void";
  EXPECT_EQ(num_begun_, 2);
  EXPECT_FALSE(hears_of_one(10));
  EXPECT_TRUE(hears_of_one(11));
}

TEST_F(Growing, AtTheEndWhatIsUnderWayOrCalledForIsWaitedFor) {
  full_bundles_.note_correction(map_of(5));
  EXPECT_TRUE(full_bundles_.last(map_of(6))) << "called for";
  EXPECT_FALSE(full_bundles_.last(map_of(6)));
  full_bundles_.note_correction(map_of(7));
  EXPECT_FALSE(hears_of_one(9));
  EXPECT_TRUE(full_bundles_.last(map_of(9))) << "under way";
  EXPECT_EQ(num_begun_, 2);
}

TEST_F(Growing, AMapThatBeginsAnewIsNotMoved) {
  full_bundles_.note_correction(map_of(5));
  EXPECT_FALSE(hears_of_one(7));
  full_bundles_.forget();
  EXPECT_FALSE(full_bundles_.last(map_of(9)));
  EXPECT_EQ(num_begun_, 1);
}

}  // namespace
}  // namespace samewhere::pipeline
