#pragma once

// For tests: a world of points, each with a descriptor of its own, and views of it without any
// picture.

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#include <samewhere/core/random.hpp>
#include <samewhere/features/features.hpp>
#include <samewhere/geometry/camera.hpp>

namespace samewhere::features {

struct TestWorld {
  std::vector<Eigen::Vector3d> points;                    // metres
  std::vector<std::array<std::uint8_t, 32>> descriptors;  // one each
};

// `count` points around the origin, 2 to 6 m away in all horizontal directions (y points down).
inline TestWorld test_world(std::uint64_t seed, int count = 4000) {
  core::Random random(seed);
  TestWorld world;
  for (int i = 0; i < count; ++i) {
    const double angle_rad = random.uniform(0.0, 6.283185307179586);
    const double distance_m = random.uniform(2.0, 6.0);
    world.points.emplace_back(distance_m * std::sin(angle_rad), random.uniform(-1.2, 1.2),
                              distance_m * std::cos(angle_rad));
    std::array<std::uint8_t, 32> descriptor{};
    for (auto& byte : descriptor) byte = static_cast<std::uint8_t>(random.index(256));
    world.descriptors.push_back(descriptor);
  }
  return world;
}

inline std::shared_ptr<const core::Rig> test_rig() {
  core::Rig rig;
  rig.cameras = {core::PinholeRadtan{640, 480, 500, 500, 320, 240}};
  rig.body_from_camera = {core::Rigid3{}};
  return std::make_shared<const core::Rig>(rig);
}

inline void append_test_feature(Features& features, const TestWorld& world, std::size_t point,
                                const Eigen::Vector2d& pixel, double depth_m) {
  features.raw_px.push_back(pixel.cast<float>());
  features.undistorted_px.push_back(pixel.cast<float>());
  features.depth_m.push_back(static_cast<float>(depth_m));
  features.right_x_px.push_back(depth_m > 0.0
                                    ? static_cast<float>(pixel.x() - 500 * 0.075 / depth_m)
                                    : std::numeric_limits<float>::quiet_NaN());
  features.octave.push_back(0);
  features.angle_rad.push_back(0.0F);
  features.rgb.push_back({1, 2, 3});
  cv::Mat row(1, 32, CV_8U);
  std::memcpy(row.ptr(0), world.descriptors[point].data(), 32);
  features.descriptors.push_back(row);
}

// What a camera at world_from_body sees: pixels with Gaussian noise, exact depth if wanted.
inline View test_view(const TestWorld& world, int frame, const core::Rigid3& world_from_body,
                      double noise_px = 0.3, bool has_depth = true) {
  core::Random random(core::seed_of(1, "view", static_cast<std::uint64_t>(frame)));
  auto features = std::make_shared<Features>();
  features->descriptors = cv::Mat(0, 32, CV_8U);
  const auto rig = test_rig();
  for (std::size_t i = 0; i < world.points.size(); ++i) {
    const Eigen::Vector3d in_camera = inverse(world_from_body) * world.points[i];
    const auto pixel = geometry::project(rig->cameras[0], in_camera);
    if (!pixel || pixel->x() < 0 || pixel->y() < 0 || pixel->x() > 639 || pixel->y() > 479)
      continue;
    const Eigen::Vector2d seen =
        *pixel + noise_px * Eigen::Vector2d(random.gaussian(), random.gaussian());
    append_test_feature(*features, world, i, seen, has_depth ? in_camera.z() : 0.0);
  }
  return {core::FrameId(static_cast<std::uint64_t>(frame)), frame / 10.0, rig, cv::Size(640, 480),
          features};
}

// The view as another day may show it: each feature looks 34 bits unlike what it did, and one
// elsewhere in the picture 38, so that the better one is hardly clear.
inline View with_near_doubles(const View& view) {
  const Features& seen = *view.features;
  auto features = std::make_shared<Features>(seen);
  features->descriptors = seen.descriptors.clone();
  const auto flip_bits = [](cv::Mat descriptor, int count) {
    for (int bit = 0; bit < count; ++bit)
      descriptor.ptr()[bit / 8] ^= static_cast<unsigned char>(1 << (bit % 8));
  };
  for (int i = 0; i < seen.size(); ++i) {
    const auto elsewhere = static_cast<std::size_t>((i + seen.size() / 2) % seen.size());
    cv::Mat unlike = seen.descriptors.row(i).clone();
    flip_bits(unlike, 38);
    flip_bits(features->descriptors.row(i), 34);
    features->raw_px.push_back(seen.raw_px[elsewhere]);
    features->undistorted_px.push_back(seen.undistorted_px[elsewhere]);
    features->depth_m.push_back(seen.depth_m[elsewhere]);
    features->right_x_px.push_back(seen.right_x_px[elsewhere]);
    features->octave.push_back(seen.octave[elsewhere]);
    features->angle_rad.push_back(seen.angle_rad[elsewhere]);
    features->rgb.push_back(seen.rgb[elsewhere]);
    features->descriptors.push_back(unlike);
  }
  View doubled = view;
  doubled.features = features;
  return doubled;
}

}  // namespace samewhere::features
