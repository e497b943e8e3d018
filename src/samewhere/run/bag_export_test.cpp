#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/open.hpp>
#include <samewhere/run/bag_export.hpp>

namespace samewhere::run {
namespace {

constexpr int kNumFrames = 12;

// Pictures of noise, with depth or a second camera, IMU and truth.
class NoiseSource : public core::Source {
 public:
  explicit NoiseSource(bool is_pair) : is_pair_(is_pair) {
    core::Rig rig;
    rig.cameras.push_back(
        core::PinholeRadtan{64, 48, 50.1, 50.2, 31.3, 23.4, 0.1, -0.2, 0.001, 0.002, 0.05});
    rig.body_from_camera.emplace_back();
    if (is_pair) {
      rig.cameras.push_back(
          core::KannalaBrandt{64, 48, 40.1, 40.2, 31.3, 23.4, 0.01, 0.02, 0.0, 0.0});
      rig.body_from_camera.push_back({.translation = {0.11, 0.0, 0.01}});
    }
    rig.imu = core::Imu{.body_from_imu = {.translation = {0.0, 0.05, 0.0}}};
    rig_ = std::make_shared<const core::Rig>(rig);
  }

  core::SourceInfo info() const override {
    return {.name = "noise",
            .format = "test",
            .num_frames = kNumFrames,
            .has_depth = !is_pair_,
            .num_cameras = is_pair_ ? 2 : 1,
            .is_calibrated = true,
            .frame_rate_hz = 30.0};
  }
  std::optional<core::Frame> next() override {
    if (next_ == kNumFrames) return std::nullopt;
    core::Frame frame;
    frame.id = core::FrameId(static_cast<std::uint64_t>(next_));
    frame.stamp_s = stamp_s(next_);
    frame.rig = rig_;
    cv::RNG random(static_cast<std::uint64_t>(next_) + 1);
    for (int i = 0; i < info().num_cameras; ++i) {
      frame.images.emplace_back(48, 64, is_pair_ ? CV_8UC1 : CV_8UC3);
      random.fill(frame.images.back(), cv::RNG::UNIFORM, 0, 256);
    }
    if (!is_pair_) {
      frame.depth_m.emplace(48, 64, CV_32FC1);
      random.fill(*frame.depth_m, cv::RNG::UNIFORM, 0.5, 8.0);
    }
    frame.imu_since_last = {{.stamp_s = frame.stamp_s - 0.001,
                             .angular_velocity_rad_s = {0.1, 0.2, 0.3 * next_},
                             .acceleration_m_s2 = {0.0, 0.0, 9.81}}};
    ++next_;
    return frame;
  }
  core::Truth truth() const override {
    core::Truth truth;
    for (int i = 0; i < kNumFrames; ++i)
      truth.trajectory.push_back({stamp_s(i), {.translation = {0.1 * i, 0.0, 1.0}}});
    return truth;
  }

  static double stamp_s(int index) { return 1305031102.175304 + 0.033 * index; }

 private:
  bool is_pair_;
  std::shared_ptr<const core::Rig> rig_;
  int next_ = 0;
};

std::filesystem::path empty_bag_folder() {
  const auto folder = std::filesystem::path(testing::TempDir()) /
                      ("samewhere_bag_export_" + std::to_string(getpid()));
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

bool is_same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

void expect_same(core::Source& expected, core::Source& found) {
  EXPECT_EQ(found.info().has_depth, expected.info().has_depth);
  EXPECT_EQ(found.info().num_cameras, expected.info().num_cameras);
  const core::Trajectory truth = found.true_trajectory();
  const core::Trajectory expected_truth = expected.true_trajectory();
  ASSERT_EQ(truth.size(), expected_truth.size());
  EXPECT_EQ(truth.back().stamp_s, expected_truth.back().stamp_s);
  EXPECT_EQ(truth.back().world_from_camera.matrix(),
            expected_truth.back().world_from_camera.matrix());
  while (const auto frame = expected.next()) {
    const auto other = found.next();
    ASSERT_TRUE(other);
    EXPECT_EQ(other->stamp_s, frame->stamp_s);
    ASSERT_EQ(other->images.size(), frame->images.size());
    for (std::size_t i = 0; i < frame->images.size(); ++i)
      EXPECT_TRUE(is_same(other->images[i], frame->images[i]));
    ASSERT_EQ(other->depth_m.has_value(), frame->depth_m.has_value());
    EXPECT_TRUE(!frame->depth_m || is_same(*other->depth_m, *frame->depth_m));
    ASSERT_EQ(other->imu_since_last.size(), 1U);
    EXPECT_EQ(other->imu_since_last[0].angular_velocity_rad_s,
              frame->imu_since_last[0].angular_velocity_rad_s);
  }
  EXPECT_FALSE(found.next());
}

TEST(BagExport, WhatIsWrittenIsReadBackToTheBit) {
  const std::filesystem::path folder = empty_bag_folder();
  for (const char* name : {"a.mcap", "a.db3", "a.bag", "folder"}) {
    for (const bool is_pair : {false, true}) {
      SCOPED_TRACE(std::string(name) + (is_pair ? " pair" : " depth"));
      NoiseSource source(is_pair);
      const std::filesystem::path file = folder / name;
      std::filesystem::remove_all(file);
      EXPECT_EQ(write_bag(source, file, {.format = bag_format_of(file)}, true), kNumFrames);
      NoiseSource expected(is_pair);
      const auto found = input::open_source(file, {});
      expect_same(expected, *found);
    }
  }
  std::filesystem::remove_all(folder);
}

TEST(BagExport, CalibrationsAreReadBackToTheBit) {
  const std::filesystem::path folder = empty_bag_folder();
  NoiseSource source(true);
  write_bag(source, folder / "a.mcap", {}, true);
  const auto found = input::open_source(folder / "a.mcap", {});
  const core::Rig& rig = *found->next()->rig;
  const core::Rig& expected = *NoiseSource(true).next()->rig;
  const auto& pinhole = std::get<core::PinholeRadtan>(rig.cameras[0]);
  EXPECT_EQ(pinhole.fx_px, 50.1);
  EXPECT_EQ(pinhole.k3, 0.05);
  EXPECT_EQ(std::get<core::KannalaBrandt>(rig.cameras[1]).k2, 0.02);
  EXPECT_EQ(rig.body_from_camera[1].translation, expected.body_from_camera[1].translation);
  EXPECT_EQ(rig.imu->body_from_imu.translation, expected.imu->body_from_imu.translation);
  std::filesystem::remove_all(folder);
}

TEST(BagExport, JpegHasTheSizeOfThePicture) {
  const std::filesystem::path folder = empty_bag_folder();
  NoiseSource source(false);
  write_bag(source, folder / "a.mcap", {.compression = bags::Compression::kZstd, .is_jpeg = true},
            true);
  const auto found = input::open_source(folder / "a.mcap", {});
  EXPECT_EQ(found->next()->images[0].size(), cv::Size(64, 48));
  std::filesystem::remove_all(folder);
}

TEST(BagExport, NamesThatCannotBeAreRefused) {
  const std::filesystem::path folder = empty_bag_folder();
  NoiseSource source(false);
  EXPECT_THROW(bag_format_of("a.avi"), core::InputError);
  EXPECT_THROW(write_bag(source, folder, {}, true), core::InputError) << "is there already";
  EXPECT_THROW(write_bag(source, folder / "new", {.format = bags::BagFormat::kRos1}, true),
               core::InputError);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace samewhere::run
