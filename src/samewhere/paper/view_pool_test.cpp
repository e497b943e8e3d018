#include <algorithm>
#include <set>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <samewhere/core/similarity.hpp>
#include <samewhere/paper/spread.hpp>
#include <samewhere/paper/view_pool.hpp>

namespace samewhere::paper {
namespace {

// Notes the frame and the size of what it sees.
class Noting : public describe::Describer {
 public:
  core::Descriptor describe(core::FrameId frame, const cv::Mat& picture) override {
    const std::vector<float> noted{static_cast<float>(frame.index()),
                                   static_cast<float>(picture.cols), 1.0F};
    return {frame, core::unit(noted), checksum()};
  }
  std::uint64_t checksum() const override { return 1; }
};

ViewPool pool_of(int num_frames, const PoolSize& size) {
  Noting describer;
  ViewPoolMaker maker(describer, num_frames, size);
  for (int i = 0; i < num_frames; ++i) maker.add(cv::Mat(30, 40, CV_8U, cv::Scalar(i % 256)));
  return std::move(maker).pool();
}

TEST(Spread, IsEvenAndWhole) {
  for (const int num_frames : {1, 6, 199, 200, 201, 457, 5000}) {
    for (const int num_wanted : {1, 7, 200}) {
      int sum = 0;
      int last = 0;
      for (int frame = 0; frame < num_frames; ++frame) {
        const int num_here = num_spread_on(frame, num_frames, num_wanted);
        for (int i = sum; i < sum + num_here; ++i) EXPECT_EQ(i * num_frames / num_wanted, frame);
        sum += num_here;
        if (num_here > 0) last = frame;
      }
      EXPECT_EQ(sum, num_wanted) << num_frames;
      EXPECT_GE(last, num_frames - 1 - num_frames / num_wanted) << "the end is left out";
    }
  }
}

TEST(ViewPool, StoresFramesThenCropsAndAsksAllOverTheWalk) {
  const ViewPool pool = pool_of(457, {.num_stored = 1000, .num_queries = 200});
  ASSERT_EQ(pool.stored.size(), 1000U);
  for (std::size_t i = 0; i < pool.stored.size(); ++i) {
    EXPECT_EQ(pool.stored[i].frame, core::FrameId(i));
    const std::vector<float>& vector = pool.stored[i].unit;
    EXPECT_NEAR(vector[0] / vector[2], static_cast<double>(i % 457), 1e-3) << "frame of view " << i;
    EXPECT_EQ(vector[1] / vector[2] > 39.5F, i < 457) << "whole or not: view " << i;
  }
  ASSERT_EQ(pool.queries.size(), 200U);
  ASSERT_EQ(pool.pictures.size(), 200U);
  EXPECT_EQ(pool.queries.back().frame, core::FrameId(454));
  EXPECT_LT(pool.queries.back().unit[1] / pool.queries.back().unit[2], 39.5F) << "a crop";
  EXPECT_EQ(pool.pictures.back().size(), cv::Size(40, 30));
}

TEST(ViewPool, OfFewFramesManyCropsAreAsked) {
  const ViewPool pool = pool_of(2, {.num_stored = 1, .num_queries = 20});
  EXPECT_EQ(pool.stored.size(), 1U);
  ASSERT_EQ(pool.queries.size(), 20U);
  std::set<float> widths;
  for (const auto& query : pool.queries) widths.insert(query.unit[1] / query.unit[2]);
  EXPECT_GT(widths.size(), 5U) << "the same crop again and again";
}

TEST(RandomCrop, LiesInThePictureWhateverItsSize) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(1, 7), cv::Size(640, 480)}) {
    const cv::Mat picture(size, CV_8U, cv::Scalar(0));
    for (std::uint64_t number = 0; number < 50; ++number) {
      const cv::Mat crop = random_crop(picture, 3, number);
      EXPECT_GE(crop.cols, std::max(1, size.width / 2)) << number;
      EXPECT_LE(crop.rows, std::max(1, static_cast<int>(0.9 * size.height))) << number;
    }
  }
}

}  // namespace
}  // namespace samewhere::paper
