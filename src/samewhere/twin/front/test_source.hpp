#pragma once

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <sys/resource.h>

#include <samewhere/core/random.hpp>
#include <samewhere/core/source.hpp>
#include <samewhere/twin/truth/truth.hpp>

namespace samewhere::twin {

// A source of small random pictures with depth, inertial samples and truth, all of one seed. For
// tests only.
class TestSource : public core::Source {
 public:
  static constexpr int kWidth_px = 40;
  static constexpr int kHeight_px = 30;
  static constexpr int kImuPerFrame = 10;
  static constexpr double kRate_hz = 15.0;

  TestSource(int num_frames, int num_cameras, std::uint64_t seed)
      : num_frames_(num_frames), seed_(seed), rig_(rig_of(num_cameras, seed)) {
    core::Random random(core::seed_of(seed, "poses", 0));
    for (int i = 0; i < num_frames; ++i) {
      truth_.trajectory.push_back({stamp_s(i), random_pose(random, 3.0)});
      truth_.inertial.push_back({.stamp_s = stamp_s(i),
                                 .velocity_m_s = random_vector(random),
                                 .gyroscope_bias_rad_s = 1e-3 * random_vector(random),
                                 .accelerometer_bias_m_s2 = 0.1 * random_vector(random)});
      if (i > 1) truth_.aliased_pairs.push_back({i, i - 2});
    }
    truth_.places = core::PlaceTruthMatrix{num_frames, {}};
    for (int i = 0; i < num_frames * num_frames; ++i) {
      truth_.places->values.push_back(static_cast<core::PlaceTruth>(i % 3));
    }
  }

  core::SourceInfo info() const override {
    return {.name = "test-walk",
            .format = "test",
            .num_frames = num_frames_,
            .has_depth = true,
            .is_calibrated = rig_->is_calibrated(),
            .frame_rate_hz = kRate_hz};
  }

  std::optional<core::Frame> next() override {
    if (next_ == num_frames_) return std::nullopt;
    core::Random random(core::seed_of(seed_, "frame", static_cast<std::uint64_t>(next_)));
    core::Frame frame;
    frame.id = core::FrameId(static_cast<std::uint64_t>(next_));
    frame.stamp_s = stamp_s(next_);
    frame.rig = rig_;
    for (std::size_t i = 0; i < std::max<std::size_t>(rig_->cameras.size(), 1); ++i) {
      frame.images.push_back(random_picture(random));
    }
    frame.depth_m = random_depth(random);
    frame.imu_since_last = random_imu(next_, random);
    ++next_;
    return frame;
  }

  core::Truth truth() const override { return truth_; }

  // As a table beside the recording has it.
  std::vector<AliasedPair> aliased_pairs() const {
    std::vector<AliasedPair> pairs;
    for (const auto& pair : truth_.aliased_pairs) pairs.push_back({pair.query, pair.match, 0.5});
    return pairs;
  }

  static double stamp_s(int i) { return 2.0 + i / kRate_hz; }

  static cv::Mat random_picture(core::Random& random) {
    cv::Mat picture(kHeight_px, kWidth_px, CV_8UC3);
    for (auto& pixel : cv::Mat_<cv::Vec3b>(picture)) {
      for (int c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint8_t>(random.index(256));
    }
    return picture;
  }

  // Whole units of 1/5000 m; every tenth unknown.
  static cv::Mat random_depth(core::Random& random) {
    cv::Mat depth_m(kHeight_px, kWidth_px, CV_32FC1);
    for (auto& pixel : cv::Mat_<float>(depth_m)) {
      const bool is_known = random.index(10) != 0;
      pixel = is_known ? static_cast<float>(1 + random.index(65534)) / 5000.0F : 0.0F;
    }
    return depth_m;
  }

 private:
  static Eigen::Vector3d random_vector(core::Random& random) {
    Eigen::Vector3d vector;
    for (double& x : vector) x = random.gaussian();
    return vector;
  }

  static core::Rigid3 random_pose(core::Random& random, double size) {
    core::Vector6d tangent;
    for (double& x : tangent) x = random.uniform(-size, size);
    return core::exp_r3so3(tangent);
  }

  static std::shared_ptr<const core::Rig> rig_of(int num_cameras, std::uint64_t seed) {
    core::Random random(core::seed_of(seed, "rig", 0));
    core::Rig rig;
    for (int i = 0; i < num_cameras; ++i) {
      rig.cameras.emplace_back(core::PinholeRadtan{.width_px = kWidth_px,
                                                   .height_px = kHeight_px,
                                                   .fx_px = 1.0 / 3.0 + 30.0 + i,
                                                   .fy_px = 31.7,
                                                   .cx_px = 19.3,
                                                   .cy_px = 14.9,
                                                   .k1 = 0.05,
                                                   .k2 = -0.08,
                                                   .p1 = 6e-4,
                                                   .p2 = -4e-4,
                                                   .k3 = i == 0 ? 0.0 : 1e-3});
      rig.body_from_camera.push_back(random_pose(random, 0.3));
    }
    if (num_cameras > 0) {
      rig.imu = core::Imu{random_pose(random, 0.1), 1.7e-4, 2.0e-3, 1.9e-5, 3.0e-3};
    }
    return std::make_shared<const core::Rig>(rig);
  }

  static std::vector<core::ImuSample> random_imu(int frame, core::Random& random) {
    std::vector<core::ImuSample> samples;
    for (int k = 1; k <= kImuPerFrame; ++k) {
      core::ImuSample sample;
      sample.stamp_s = stamp_s(frame) + (k - kImuPerFrame) / (kRate_hz * kImuPerFrame);
      for (double& w : sample.angular_velocity_rad_s) w = random.gaussian();
      for (double& a : sample.acceleration_m_s2) a = 9.0 * random.gaussian();
      samples.push_back(sample);
    }
    return samples;
  }

  int num_frames_;
  std::uint64_t seed_;
  std::shared_ptr<const core::Rig> rig_;
  core::Truth truth_;
  int next_ = 0;
};

// While it lives, no file of this process grows beyond a thousand bytes. For tests only.
class FullDisk {
 public:
  FullDisk() {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit full{1000, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &full);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;
  ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

}  // namespace samewhere::twin
