#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include <samewhere/paper/slam_rows.hpp>

namespace samewhere::paper {
namespace {

TEST(SlamConfig, IsTheProfileOfTheConfiguration) {
  pipeline::Config base = pipeline::profile("paper");
  base.source = "/data/hall";
  base.retrieve.window_frames = 149;
  for (const ComparedMethod& each : slam_configurations()) {
    const std::string& configuration = each.name;
    const pipeline::Config config = slam_config(base, configuration, 2);
    EXPECT_EQ(config.source, "/data/hall") << configuration;
    EXPECT_EQ(config.seed, 2) << configuration;
    EXPECT_EQ(config.retrieve.window_frames, -1) << "SLAM has a window of its own";
    EXPECT_EQ(config.close_loops, configuration != "off") << configuration;
  }
  EXPECT_EQ(slam_config(base, "usual", 0).verify.min_inliers, 12);
}

TEST(SlamRow, HoldsErrorsAndPathOfARealRecording) {
  const char* data = std::getenv("SAMEWHERE_DATA");
  if (data == nullptr) GTEST_SKIP() << "SAMEWHERE_DATA is not set";
  pipeline::Config base;
  base.source = std::string(data) + "/tum_fr1_rpy";
  ASSERT_FALSE(why_no_slam(base).has_value());
  const auto row = run_slam_once(slam_config(base, "usual", 0), "rpy", "usual");
  ASSERT_TRUE(row.has_value());
  EXPECT_EQ(row->recording, "rpy");
  EXPECT_EQ(row->configuration, "usual");
  EXPECT_EQ(row->num_frames, 200);
  EXPECT_GT(row->num_measured, 190);
  EXPECT_GT(row->frames_per_second, 0.0);
  ASSERT_TRUE(row->ate_m.has_value());
  EXPECT_LT(row->ate_m->min, row->ate_m->median);
  EXPECT_LT(row->ate_m->rmse, row->ate_m->max);
  EXPECT_LT(row->ate_m->max, 0.2);
  // the path is aligned: its error is the ATE
  ASSERT_GT(row->path.size(), 150u);
  double sum = 0.0;
  for (const PathPoint& point : row->path) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      sum += std::pow(point.estimate[axis] - point.truth[axis], 2);
  }
  EXPECT_NEAR(std::sqrt(sum / static_cast<double>(row->path.size())), row->ate_m->rmse, 1e-3);
}

}  // namespace
}  // namespace samewhere::paper
