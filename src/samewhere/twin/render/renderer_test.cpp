
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <samewhere/geometry/camera.hpp>
#include <samewhere/twin/building/test_room.hpp>
#include <samewhere/twin/front/camera.hpp>
#include <samewhere/twin/front/walkthrough.hpp>
#include <samewhere/twin/motion/people.hpp>
#include <samewhere/twin/render/renderer.hpp>
#include <samewhere/twin/render/test_pictures.hpp>

namespace samewhere::twin {
namespace {

float mean_of(const cv::Vec3f& colour) { return (colour[0] + colour[1] + colour[2]) / 3.0F; }

// The front, that looks along -x, the back and the top of a box.
std::vector<Rectangle> crate(const Eigen::Vector3f& low_m, const Eigen::Vector3f& high_m) {
  const Material paint{.finish = Finish::kPaint, .colour = Colour::Constant(0.5F)};
  const Eigen::Vector3f size_m = high_m - low_m;
  const Eigen::Vector3f x = Eigen::Vector3f::UnitX();
  const Eigen::Vector3f y = Eigen::Vector3f::UnitY();
  const Eigen::Vector3f z = Eigen::Vector3f::UnitZ();
  return {{.corner_m = {low_m.x(), high_m.y(), low_m.z()},
           .right = -y,
           .up = z,
           .size_m = {size_m.y(), size_m.z()},
           .material = paint},
          {.corner_m = {high_m.x(), low_m.y(), low_m.z()},
           .right = y,
           .up = z,
           .size_m = {size_m.y(), size_m.z()},
           .material = paint},
          {.corner_m = {low_m.x(), low_m.y(), high_m.z()},
           .right = x,
           .up = y,
           .size_m = {size_m.x(), size_m.y()},
           .material = paint}};
}

TEST(Renderer, EveryPixelSeesWhatASingleRayMeets) {
  const Walkthrough walk(parse_spec("twin:office-loop?seed=3"), {.num_frames = 31});
  const Building& building = *walk.visits().front().building;
  const RayScene& rays = *walk.visits().front().rays;
  const core::Camera camera = kTwinCamera;
  const Renderer renderer(building, rays, camera, kNumThreads);
  const core::Rigid3 world_from_camera = walk.walk().poses[30].world_from_camera;
  const View view = renderer.render(world_from_camera);
  const Eigen::Vector3f position = world_from_camera.translation.cast<float>();
  int num_seen = 0;
  for (int y = 1; y < view.surface.rows; y += 7) {
    for (int x = 3; x < view.surface.cols; x += 7) {
      const Eigen::Vector3d bearing = geometry::bearing(camera, {x, y});
      const Eigen::Vector3f direction =
          (world_from_camera.rotation * (bearing / bearing.z())).cast<float>();
      const auto hit = rays.first_hit({position, direction});
      ASSERT_TRUE(hit);
      ++num_seen;
      if (view.surface.at<int>(y, x) != hit->rectangle) continue;  // an edge, to the last bit
      EXPECT_NEAR(view.depth_m.at<float>(y, x), hit->reach, 1e-4F * hit->reach);
      const Eigen::Vector3f normal =
          building.rectangles[static_cast<std::size_t>(hit->rectangle)].normal();
      EXPECT_NEAR(view.incidence.at<float>(y, x), -normal.dot(direction.normalized()), 1e-4F)
          << "surface " << hit->rectangle << " at " << x << ", " << y;
      --num_seen;
    }
  }
  EXPECT_LT(num_seen, 10) << "pixels whose packet met something else";
}

TEST(Renderer, TheSamePlaceGivesTheSameBytes) {
  const TestRoom room(Colour::Constant(0.5F));
  const RayScene rays(room.building.rectangles);
  const Renderer first(room.building, rays, kSmallCamera, kNumThreads);
  const Renderer again(room.building, rays, kSmallCamera, kNumThreads);
  const Person person({{-2, 0, 0}, {2, 0, 0}}, 4);
  const core::Rigid3 pose = looking({-2.5, 0.3, 1.5}, 0.0);
  const View one = first.render(pose, person.at(1.0));
  const View two = again.render(pose, person.at(1.0));
  EXPECT_TRUE(is_same(one.radiance, two.radiance));
  EXPECT_TRUE(is_same(one.depth_m, two.depth_m));
  EXPECT_TRUE(is_same(one.surface, two.surface));
}

TEST(Renderer, WhatMovesHidesWhatIsBehindIt) {
  const TestRoom room(Colour::Constant(0.5F));
  const RayScene rays(room.building.rectangles);
  const Renderer renderer(room.building, rays, kSmallCamera, kNumThreads);
  const core::Rigid3 pose = looking({-2.5, 0.0, 1.5}, 0.0);
  const auto box = crate({0.5F, -0.3F, 1.2F}, {1.0F, 0.3F, 1.8F});
  const View empty = renderer.render(pose);
  const View view = renderer.render(pose, box);
  const int num_at_rest = static_cast<int>(room.building.rectangles.size());
  const cv::Point middle(80, 60);
  EXPECT_GE(view.surface.at<int>(middle), num_at_rest);
  EXPECT_NEAR(view.depth_m.at<float>(middle), 3.0F, 1e-4F);
  EXPECT_NEAR(empty.depth_m.at<float>(middle), 5.5F, 1e-4F);
  // its front is 0.6 m wide at 3 m
  int num_covered = 0;
  for (int x = 0; x < view.surface.cols; ++x) {
    num_covered += static_cast<int>(view.surface.at<int>(60, x) >= num_at_rest);
  }
  EXPECT_NEAR(num_covered, 130.0 * 0.6 / 3.0, 2.0);
  EXPECT_EQ(view.radiance.at<cv::Vec3f>(60, 5), empty.radiance.at<cv::Vec3f>(60, 5));
}

TEST(Renderer, AThingBehindAWallStaysHidden) {
  const TestRoom room(Colour::Constant(0.5F));
  const RayScene rays(room.building.rectangles);
  const Renderer renderer(room.building, rays, kSmallCamera, kNumThreads);
  const core::Rigid3 pose = looking({-2.5, 0.0, 1.5}, 0.0);
  const auto box = crate({4.0F, -0.3F, 1.2F}, {4.5F, 0.3F, 1.8F});
  EXPECT_TRUE(is_same(renderer.render(pose).surface, renderer.render(pose, box).surface));
}

TEST(Renderer, WhatMovesIsLitByTheRoomAndDarkensTheFloorBelowIt) {
  const TestRoom room(Colour::Constant(0.5F));
  const TestRoom dim(Colour::Constant(0.5F), 1.0F);
  const RayScene rays(room.building.rectangles);
  const Renderer renderer(room.building, rays, kSmallCamera, kNumThreads);
  const Renderer with_dim_lamp(dim.building, rays, kSmallCamera, kNumThreads);
  const core::Rigid3 pose = looking({-2.5, 0.0, 1.2}, 0.0);
  const auto box = crate({0.5F, -0.3F, 0.02F}, {1.0F, 0.3F, 0.6F});
  const View view = renderer.render(pose, box);
  const auto front_px = static_cast<int>(60 + 130.0 * 0.9 / 3.0);
  const float front = mean_of(view.radiance.at<cv::Vec3f>(front_px, 80));
  const float dim_front =
      mean_of(with_dim_lamp.render(pose, box).radiance.at<cv::Vec3f>(front_px, 80));
  EXPECT_GT(front, 0.01F);
  EXPECT_NEAR(dim_front / front, 0.1F, 0.02F);
  // the face that looks up sees the lamp, the front sees it from aside
  const auto top_px = static_cast<int>(60 + 130.0 * 0.6 / 3.25);
  EXPECT_GT(mean_of(view.radiance.at<cv::Vec3f>(top_px, 80)), 1.2F * front);
  const auto floor_px = static_cast<int>(60 + 130.0 * 1.2 / 2.93);
  const View empty = renderer.render(pose);
  EXPECT_LT(mean_of(view.radiance.at<cv::Vec3f>(floor_px, 80)),
            0.85F * mean_of(empty.radiance.at<cv::Vec3f>(floor_px, 80)));
}

TEST(Renderer, APolishedFloorMirrorsTheLampWhereTheEyeHasIt) {
  TestRoom room(Colour::Constant(0.3F));
  const RayScene rays(room.building.rectangles);
  // the middle of the picture, seen from a place; from x = -2.5 m it is the lamp's mirror image
  const auto middle_from = [&](double x_m) {
    core::Rigid3 pose = looking({x_m, 0.0, 1.0}, 0.0);
    const double down_rad = std::atan2(1.0 + TestRoom::kLamp_m, 2.5);
    pose.rotation *= Eigen::Quaterniond(Eigen::AngleAxisd(-down_rad, Eigen::Vector3d::UnitX()));
    const Renderer renderer(room.building, rays, kSmallCamera, kNumThreads);
    return mean_of(renderer.render(pose).radiance.at<cv::Vec3f>(60, 80));
  };
  const float matt = middle_from(-2.5);
  const float matt_from_nearer = middle_from(-1.5);
  room.building.rectangles[TestRoom::kFloor].material.gloss = 1.0F;
  const float lamp = middle_from(-2.5) - matt;
  const float ceiling = middle_from(-1.5) - matt_from_nearer;
  EXPECT_GT(lamp, 0.1F);
  EXPECT_GT(ceiling, 0.0F);
  EXPECT_LT(ceiling, 0.2F * lamp);
  // what is rough spreads it
  room.building.rectangles[TestRoom::kFloor].material.roughness_rad = 0.1F;
  const float spread = middle_from(-2.5) - matt;
  EXPECT_GT(spread, 0.05F * lamp);
  EXPECT_LT(spread, 0.8F * lamp);
}

TEST(Renderer, TheMeterReadsTheMeanOfThePicture) {
  const TestRoom room(Colour::Constant(0.5F));
  const RayScene rays(room.building.rectangles);
  const Renderer renderer(room.building, rays, kSmallCamera, kNumThreads);
  for (const double heading_rad : {0.0, 1.0, 2.5}) {
    const core::Rigid3 pose = looking({-1.0, 0.3, 1.2}, heading_rad);
    const cv::Scalar mean = cv::mean(renderer.render(pose).radiance);
    const double expected = (mean[0] + mean[1] + mean[2]) / 3.0;
    EXPECT_NEAR(renderer.mean_radiance(pose), expected, 0.2 * expected);
  }
}

}  // namespace
}  // namespace samewhere::twin
