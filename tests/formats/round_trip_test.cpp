// Folders written in the TUM and EuRoC formats are read back unchanged.

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "program.hpp"
#include <samewhere/input/open.hpp>
#include <samewhere/input/test_folder.hpp>
#include <samewhere/twin/front/dataset.hpp>
#include <samewhere/twin/front/test_source.hpp>

namespace samewhere::test {
namespace {

constexpr int kNumFrames = 6;
constexpr double kTumStep_s = 1e-6;    // six decimals
constexpr double kEurocStep_s = 1e-9;  // whole nanoseconds
constexpr double kMaxPoseError = 1e-6;

void expect_same_pixels(const cv::Mat& found, const cv::Mat& expected) {
  ASSERT_EQ(found.size(), expected.size());
  ASSERT_EQ(found.type(), expected.type());
  EXPECT_EQ(cv::norm(found, expected, cv::NORM_INF), 0.0);
}

void expect_same_pose(const core::Rigid3& found, const core::Rigid3& expected) {
  EXPECT_LT(core::log_r3so3(core::inverse(expected) * found).norm(), kMaxPoseError);
}

void expect_same_camera(const core::Camera& found, const core::Camera& expected) {
  const auto& a = std::get<core::PinholeRadtan>(found);
  const auto& b = std::get<core::PinholeRadtan>(expected);
  EXPECT_EQ(a.width_px, b.width_px);
  EXPECT_EQ(a.height_px, b.height_px);
  EXPECT_EQ(a.fx_px, b.fx_px);
  EXPECT_EQ(a.fy_px, b.fy_px);
  EXPECT_EQ(a.cx_px, b.cx_px);
  EXPECT_EQ(a.cy_px, b.cy_px);
  EXPECT_EQ(a.k1, b.k1);
  EXPECT_EQ(a.k2, b.k2);
  EXPECT_EQ(a.p1, b.p1);
  EXPECT_EQ(a.p2, b.p2);
  EXPECT_EQ(a.k3, b.k3);
}

void expect_same_truth(const core::Truth& found, const core::Truth& expected, double max_step_s) {
  ASSERT_EQ(found.trajectory.size(), expected.trajectory.size());
  for (std::size_t i = 0; i < expected.trajectory.size(); ++i) {
    EXPECT_NEAR(found.trajectory[i].stamp_s, expected.trajectory[i].stamp_s, max_step_s);
    expect_same_pose(found.trajectory[i].world_from_camera,
                     expected.trajectory[i].world_from_camera);
  }
  ASSERT_TRUE(found.places);
  EXPECT_EQ(found.places->values, expected.places->values);
  EXPECT_FALSE(expected.aliased_pairs.empty());
  EXPECT_EQ(found.aliased_pairs, expected.aliased_pairs);
}

void expect_same_inertial_truth(const std::vector<core::InertialTruth>& found,
                                const std::vector<core::InertialTruth>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(found[i].stamp_s, expected[i].stamp_s, kEurocStep_s);
    EXPECT_LT((found[i].velocity_m_s - expected[i].velocity_m_s).norm(), 1e-8);
    EXPECT_LT((found[i].gyroscope_bias_rad_s - expected[i].gyroscope_bias_rad_s).norm(), 1e-11);
    EXPECT_LT((found[i].accelerometer_bias_m_s2 - expected[i].accelerometer_bias_m_s2).norm(),
              1e-8);
  }
}

void expect_same_imu(const std::vector<core::ImuSample>& found,
                     const std::vector<core::ImuSample>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(found[i].stamp_s, expected[i].stamp_s, kEurocStep_s);
    EXPECT_LT((found[i].angular_velocity_rad_s - expected[i].angular_velocity_rad_s).norm(), 1e-9);
    EXPECT_LT((found[i].acceleration_m_s2 - expected[i].acceleration_m_s2).norm(), 1e-8);
  }
}

void expect_same_rig(const core::Rig& found, const core::Rig& expected) {
  ASSERT_EQ(found.cameras.size(), expected.cameras.size());
  for (std::size_t i = 0; i < expected.cameras.size(); ++i) {
    expect_same_camera(found.cameras[i], expected.cameras[i]);
    expect_same_pose(found.body_from_camera[i], expected.body_from_camera[i]);
  }
  ASSERT_TRUE(found.imu);
  expect_same_pose(found.imu->body_from_imu, expected.imu->body_from_imu);
  EXPECT_EQ(found.imu->gyroscope_noise_rad_s_sqrt_hz, expected.imu->gyroscope_noise_rad_s_sqrt_hz);
  EXPECT_EQ(found.imu->accelerometer_noise_m_s2_sqrt_hz,
            expected.imu->accelerometer_noise_m_s2_sqrt_hz);
  EXPECT_EQ(found.imu->gyroscope_bias_walk_rad_s2_sqrt_hz,
            expected.imu->gyroscope_bias_walk_rad_s2_sqrt_hz);
  EXPECT_EQ(found.imu->accelerometer_bias_walk_m_s3_sqrt_hz,
            expected.imu->accelerometer_bias_walk_m_s3_sqrt_hz);
}

twin::MakeTables tables_of(const twin::TestSource& source) {
  return [&source] {
    return twin::SideTables{.truth = {.frames = std::vector<twin::FrameTruth>(kNumFrames),
                                      .aliased_pairs = source.aliased_pairs()},
                            .wheels = {}};
  };
}

// By the format check, which is independent of our readers.
void expect_good_format(const std::filesystem::path& folder) {
  const std::string check = "'" SAMEWHERE_REPOSITORY "/scripts/check-dataset' " + quoted(folder);
  EXPECT_EQ(std::system(check.c_str()), 0) << folder;
}

TEST(RoundTrip, ATumFolderIsReadBackUnchanged) {
  const input::TestFolder folder;
  twin::TestSource written(kNumFrames, 1, 3);
  twin::write_tum_folder(written, folder.root() / "walk", tables_of(written));
  const auto read = input::open_source(folder.root() / "walk", input::Config{});
  EXPECT_EQ(read->info().format, "TUM RGB-D");
  expect_good_format(folder.root() / "walk");
  expect_same_truth(read->truth(), written.truth(), kTumStep_s);
  twin::TestSource expected(kNumFrames, 1, 3);
  while (const auto frame = expected.next()) {
    const auto found = read->next();
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->stamp_s, frame->stamp_s, kTumStep_s);
    expect_same_pixels(found->images.at(0), frame->images[0]);
    ASSERT_TRUE(found->depth_m);
    expect_same_pixels(*found->depth_m, *frame->depth_m);
    expect_same_camera(found->rig->cameras.at(0), frame->rig->cameras[0]);
  }
  EXPECT_FALSE(read->next());
}

TEST(RoundTrip, AEurocFolderIsReadBackUnchanged) {
  for (const int num_cameras : {1, 2}) {
    const input::TestFolder folder;
    twin::TestSource written(kNumFrames, num_cameras, 4);
    twin::write_euroc_folder(written, folder.root() / "walk", tables_of(written));
    const auto read = input::open_source(folder.root() / "walk", input::Config{});
    EXPECT_EQ(read->info().format, "EuRoC");
    expect_good_format(folder.root() / "walk");
    expect_same_truth(read->truth(), written.truth(), kEurocStep_s);
    expect_same_inertial_truth(read->truth().inertial, written.truth().inertial);
    twin::TestSource expected(kNumFrames, num_cameras, 4);
    while (const auto frame = expected.next()) {
      const auto found = read->next();
      ASSERT_TRUE(found);
      EXPECT_NEAR(found->stamp_s, frame->stamp_s, kEurocStep_s);
      ASSERT_EQ(found->images.size(), frame->images.size());
      for (std::size_t i = 0; i < frame->images.size(); ++i) {
        expect_same_pixels(found->images[i], frame->images[i]);
      }
      expect_same_imu(found->imu_since_last, frame->imu_since_last);
      expect_same_rig(*found->rig, *frame->rig);
    }
    EXPECT_FALSE(read->next());
  }
}

}  // namespace
}  // namespace samewhere::test
