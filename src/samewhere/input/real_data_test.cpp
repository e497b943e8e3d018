#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <samewhere/core/nanoseconds.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/input/open.hpp>
#include <samewhere/input/prefetch.hpp>

namespace samewhere::input {
namespace {

// Real recordings, where SAMEWHERE_DATA says they lie.
class RealData : public testing::Test {
 protected:
  void SetUp() override {
    const char* folder = std::getenv("SAMEWHERE_DATA");
    if (folder == nullptr) GTEST_SKIP() << "SAMEWHERE_DATA is not set";
    data_ = folder;
  }

  std::unique_ptr<core::Source> open(const std::string& name) const {
    return prefetched(open_source(data_ / name, Config{}));
  }

  std::filesystem::path data_;
};

// Share of pixels with a depth, and their mean, m.
struct DepthSummary {
  double known_ratio = 0.0;
  double mean_m = 0.0;
};

DepthSummary summarize(const cv::Mat& depth_m) {
  const cv::Mat is_known = depth_m > 0.0F;
  const double num_known = cv::countNonZero(is_known);
  return {num_known / static_cast<double>(depth_m.total()), cv::mean(depth_m, is_known)[0]};
}

void expect_a_room(const core::Frame& frame) {
  ASSERT_TRUE(frame.depth_m) << frame.name;
  const DepthSummary depth = summarize(*frame.depth_m);
  EXPECT_GT(depth.known_ratio, 0.3) << frame.name;
  EXPECT_GT(depth.mean_m, 0.5) << frame.name;
  EXPECT_LT(depth.mean_m, 5.0) << frame.name;
}

// Reads it all; expects ids without gaps, rising stamps and one image size.
std::vector<double> read_stamps(core::Source& source) {
  std::vector<double> stamps_s;
  while (const std::optional<core::Frame> frame = source.next()) {
    EXPECT_EQ(frame->id, core::FrameId(stamps_s.size()));
    EXPECT_GT(frame->stamp_s, stamps_s.empty() ? -1.0 : stamps_s.back());
    stamps_s.push_back(frame->stamp_s);
  }
  return stamps_s;
}

TEST_F(RealData, RedKitchen) {
  const auto source = open("redkitchen");
  EXPECT_EQ(source->info().name, "redkitchen");
  EXPECT_EQ(source->info().format, "7-Scenes");
  EXPECT_EQ(source->info().num_frames, 1000);
  const core::Truth truth = source->truth();
  ASSERT_EQ(truth.trajectory.size(), 1000U);
  // the pose files say the same as groundtruth.tum
  const core::Trajectory same = core::read_tum(data_ / "redkitchen/groundtruth.tum");
  for (std::size_t i = 0; i < same.size(); i += 37) {
    const core::Rigid3 difference =
        core::inverse(same[i].world_from_camera) * truth.trajectory[i].world_from_camera;
    EXPECT_LT(core::log_r3so3(difference).norm(), 1e-4) << i;
    EXPECT_NEAR(same[i].stamp_s, truth.trajectory[i].stamp_s, 1e-6) << i;
  }
  ASSERT_TRUE(truth.places);
  EXPECT_EQ(truth.places->num_frames, 1000);
  EXPECT_EQ(truth.places->at(999, 999), core::PlaceTruth::kSame);
  const auto first = source->next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->images[0].size(), cv::Size(640, 480));
  expect_a_room(*first);
  EXPECT_EQ(first->stamp_s, 0.0);
  EXPECT_DOUBLE_EQ(source->next()->stamp_s, core::in_whole_nanoseconds(1.0 / 30.0));
}

TEST_F(RealData, TumFr1Rpy) {
  const auto source = open("tum_fr1_rpy");
  EXPECT_EQ(source->info().format, "TUM RGB-D");
  EXPECT_EQ(source->info().num_frames, 200);
  const core::Truth truth = source->truth();
  const auto first = source->next();
  ASSERT_TRUE(first);
  EXPECT_DOUBLE_EQ(first->stamp_s, 1305031229.528748);
  expect_a_room(*first);
  const auto& camera = std::get<core::PinholeRadtan>(first->rig->cameras.at(0));
  EXPECT_EQ(camera.width_px, 640);
  EXPECT_DOUBLE_EQ(camera.k2, -0.953104);
  ASSERT_GT(truth.trajectory.size(), 1000U);
  EXPECT_LT(truth.trajectory.front().stamp_s, first->stamp_s);
  EXPECT_FALSE(truth.places);
  int num_with_depth = 1;
  int num_frames = 1;
  for (; const auto frame = source->next(); ++num_frames) num_with_depth += frame->depth_m ? 1 : 0;
  EXPECT_EQ(num_frames, 200);
  EXPECT_GT(num_with_depth, 190);
}

TEST_F(RealData, HoloLens) {
  const auto source = open("hololens");
  EXPECT_EQ(source->info().format, "HoloLens");
  EXPECT_EQ(source->info().num_frames, 373);
  const core::Truth truth = source->truth();
  ASSERT_EQ(truth.trajectory.size(), 373U);
  EXPECT_DOUBLE_EQ(truth.trajectory.back().stamp_s, 378.0 / 12.0);
  ASSERT_TRUE(truth.places);
  EXPECT_EQ(truth.places->num_frames, 373);
  const auto first = source->next();
  ASSERT_TRUE(first);
  EXPECT_DOUBLE_EQ(first->stamp_s, 0.25);
  EXPECT_EQ(first->images[0].size(), cv::Size(540, 360));
  expect_a_room(*first);
}

TEST_F(RealData, RtabmapCorridor) {
  const auto source = open("rtabmap_corridor");
  EXPECT_EQ(source->info().format, "images");
  EXPECT_FALSE(source->info().is_calibrated);
  EXPECT_FALSE(source->info().has_depth);
  const core::Truth truth = source->truth();
  ASSERT_TRUE(truth.places);
  int num_queries_with_loop = 0;  // docs/evaluation.md: 44, outside a window of 19 frames
  for (int query = 0; query < truth.places->num_frames; ++query) {
    bool has_loop = false;
    for (int match = 0; match < query - 19; ++match) {
      has_loop = has_loop || truth.places->at(query, match) == core::PlaceTruth::kSame;
    }
    num_queries_with_loop += has_loop ? 1 : 0;
  }
  EXPECT_EQ(num_queries_with_loop, 44);
  const std::vector<double> stamps_s = read_stamps(*source);
  ASSERT_EQ(stamps_s.size(), 84U);
  EXPECT_DOUBLE_EQ(stamps_s.front(), core::in_whole_nanoseconds(1.0 / 30.0));
}

TEST_F(RealData, TheTowerWalkIsAList) {
  const auto source = open_source(data_ / "ie_tower/walk.txt", Config{});
  EXPECT_EQ(source->info().num_frames, 2877);
  EXPECT_EQ(source->next()->name, "basement4/b4_auditorium_main_c024_frame_000001.jpg");
}

}  // namespace
}  // namespace samewhere::input
