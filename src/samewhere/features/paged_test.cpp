#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <samewhere/features/paged.hpp>
#include <samewhere/features/test_world.hpp>

namespace samewhere::features {
namespace {

std::shared_ptr<const Features> some_features() {
  return test_view(test_world(1), 0, core::Rigid3{}).features;
}

bool are_same(const Features& a, const Features& b) {
  const bool are_equally_right =
      std::equal(a.right_x_px.begin(), a.right_x_px.end(), b.right_x_px.begin(), b.right_x_px.end(),
                 [](float x, float y) { return x == y || (std::isnan(x) && std::isnan(y)); });
  return a.raw_px == b.raw_px && a.undistorted_px == b.undistorted_px && a.depth_m == b.depth_m &&
         are_equally_right && a.octave == b.octave && a.angle_rad == b.angle_rad &&
         a.rgb == b.rgb && a.descriptors.size() == b.descriptors.size() &&
         cv::countNonZero(a.descriptors != b.descriptors) == 0;
}

TEST(PagedFeatures, AreTheSameBeforeAndAfterTheyLeftMemory) {
  const auto features = some_features();
  ASSERT_GT(features->size(), 100);
  core::PagedMemory memory;
  const auto kept = paged(features, memory);
  ASSERT_NE(kept->pages, nullptr);
  EXPECT_TRUE(are_same(*kept, *features));
  leave_memory(*kept);
  EXPECT_TRUE(are_same(*kept, *features));
  EXPECT_EQ(paged(kept, memory), kept) << "they are paged already";
}

TEST(PagedFeatures, EachArrayLiesInTheirBlock) {
  core::PagedMemory memory;
  const auto kept = paged(some_features(), memory);
  const auto lies_inside = [&](const void* begin) {
    const auto bytes = kept->pages->bytes();
    return begin >= bytes.data() && begin < bytes.data() + bytes.size();
  };
  EXPECT_TRUE(lies_inside(kept->raw_px.data()));
  EXPECT_TRUE(lies_inside(kept->rgb.data()));
  EXPECT_TRUE(lies_inside(kept->descriptors.data));
}

TEST(PagedFeatures, ACopyLivesOnWithoutThem) {
  core::PagedMemory memory;
  auto kept = paged(some_features(), memory);
  const Features copy = *kept;
  const auto original = some_features();
  kept.reset();
  EXPECT_TRUE(are_same(copy, *original));
}

TEST(PagedFeatures, ThoseOfAnEmptyPictureStayEmpty) {
  core::PagedMemory memory;
  const auto kept = paged(std::make_shared<Features>(), memory);
  EXPECT_EQ(kept->size(), 0);
  EXPECT_TRUE(kept->descriptors.empty());
  leave_memory(*kept);
}

TEST(PagedFeatures, ThoseInOrdinaryMemoryStay) {
  const auto features = some_features();
  leave_memory(*features);
  EXPECT_TRUE(are_same(*features, *some_features()));
}

}  // namespace
}  // namespace samewhere::features
