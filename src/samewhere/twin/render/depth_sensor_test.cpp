#include <cmath>

#include <gtest/gtest.h>

#include <samewhere/twin/building/test_room.hpp>
#include <samewhere/twin/motion/people.hpp>
#include <samewhere/twin/render/depth_sensor.hpp>

namespace samewhere::twin {
namespace {

TEST(DepthSensor, MeasuresAWholeNumberOfItsUnits) {
  const TestRoom room(Colour::Constant(0.5F));
  const RayScene rays(room.building.rectangles);
  const Renderer renderer(room.building, rays, kSmallCamera, kNumThreads);
  const View view = renderer.render(looking({-2.5, 0.0, 1.5}, 0.3));
  const cv::Mat measured_m = measure_depth(view, room.building, 5);
  int num_measured = 0;
  for (int y = 0; y < measured_m.rows; ++y) {
    for (int x = 0; x < measured_m.cols; ++x) {
      const float depth_m = measured_m.at<float>(y, x);
      const auto in_file = static_cast<std::uint16_t>(std::lround(depth_m * 5000.0F));
      ASSERT_EQ(static_cast<float>(in_file) / 5000.0F, depth_m) << x << ' ' << y;
      num_measured += static_cast<int>(in_file > 0);
    }
  }
  EXPECT_GT(num_measured, 0.5 * view.depth_m.total());
}

TEST(DepthSensor, SeesPeopleButNoLamps) {
  const TestRoom room(Colour::Constant(0.5F));
  const RayScene rays(room.building.rectangles);
  const Renderer renderer(room.building, rays, kSmallCamera, kNumThreads);
  const Person person({{-0.5, -1.0, 0}, {-0.5, 1.0, 0}}, 3);
  const View view = renderer.render(looking({-2.5, 0.0, 1.5}, 0.0), person.at(2.0));
  const cv::Mat measured_m = measure_depth(view, room.building, 5);
  const int num_at_rest = static_cast<int>(room.building.rectangles.size());
  int num_on_person = 0;
  int num_measured = 0;
  for (int y = 0; y < measured_m.rows; ++y) {
    for (int x = 0; x < measured_m.cols; ++x) {
      const int surface = view.surface.at<int>(y, x);
      if (surface == num_at_rest - 1) {
        EXPECT_EQ(measured_m.at<float>(y, x), 0.0F) << "a lamp";
      }
      if (surface < num_at_rest) continue;
      ++num_on_person;
      num_measured += static_cast<int>(measured_m.at<float>(y, x) > 0.0F);
    }
  }
  EXPECT_GT(num_on_person, 200);
  EXPECT_GT(num_measured, 0.4 * num_on_person);
}

}  // namespace
}  // namespace samewhere::twin
