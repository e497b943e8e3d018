#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include <samewhere/dense/view.hpp>
#include <samewhere/geometry/camera.hpp>

namespace samewhere::dense {

// A room with a box in it, and exact depth images of both. In the room's frame z is up, the floor
// is z = 0 and a corner the origin; the world is turned against it. For tests only.
class TestRoom {
 public:
  inline static const Eigen::Vector3d kSize_m{4.0, 3.0, 2.5};
  inline static const Eigen::AlignedBox3d kBox_m{Eigen::Vector3d(2.6, 1.0, 0.0),
                                                 Eigen::Vector3d(3.2, 1.6, 0.8)};
  static constexpr int kWidth_px = 160;
  static constexpr int kHeight_px = 120;

  static core::Rigid3 world_from_room() {
    return {
        Eigen::Quaterniond(Eigen::AngleAxisd(1.9, Eigen::Vector3d(0.9, 0.2, -0.3).normalized())),
        {1.0, -2.0, 0.5}};
  }

  static core::PinholeRadtan camera() {
    return {.width_px = kWidth_px,
            .height_px = kHeight_px,
            .fx_px = 110.0,
            .fy_px = 110.0,
            .cx_px = 79.5,
            .cy_px = 59.5};
  }

  // Views around the room from several places at 1.2 m, looking down by 0.35 rad.
  static std::vector<View> walk() {
    constexpr int kNumTurns = 12;
    std::vector<View> views;
    for (const Eigen::Vector2d& place :
         {Eigen::Vector2d(0.8, 0.7), Eigen::Vector2d(0.9, 2.2), Eigen::Vector2d(2.0, 2.4),
          Eigen::Vector2d(3.6, 2.3), Eigen::Vector2d(3.6, 0.6)}) {
      for (int i = 0; i < kNumTurns; ++i) {
        views.push_back(view({place.x(), place.y(), 1.2}, 2.0 * std::numbers::pi * i / kNumTurns));
      }
    }
    return views;
  }

  static View view(const Eigen::Vector3d& place_in_room, double yaw_rad) {
    constexpr double kDown_rad = 0.35;
    const Eigen::Vector3d forward(std::cos(yaw_rad) * std::cos(kDown_rad),
                                  std::sin(yaw_rad) * std::cos(kDown_rad), -std::sin(kDown_rad));
    const Eigen::Vector3d right(std::sin(yaw_rad), -std::cos(yaw_rad), 0.0);
    Eigen::Matrix3d room_from_camera;
    room_from_camera << right, forward.cross(right), forward;
    return photographed({Eigen::Quaterniond(room_from_camera), place_in_room});
  }

  // Metres from the nearest surface.
  static double distance_m(const Eigen::Vector3d& in_room) {
    const double wall_m =
        std::min(in_room.cwiseAbs().minCoeff(), (kSize_m - in_room).cwiseAbs().minCoeff());
    const double inside_m =
        std::min((in_room - kBox_m.min()).minCoeff(), (kBox_m.max() - in_room).minCoeff());
    const double box_m =
        kBox_m.contains(in_room) ? inside_m : std::sqrt(kBox_m.squaredExteriorDistance(in_room));
    return std::min(wall_m, box_m);
  }

 private:
  // Along a ray from within the room: how many times its direction to the next surface.
  static double length_to_surface(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) {
    double length = std::numeric_limits<double>::max();
    double enter = 0.0;
    double leave = std::numeric_limits<double>::max();
    for (int axis = 0; axis < 3; ++axis) {
      const double wall = direction[axis] > 0.0 ? kSize_m[axis] : 0.0;
      length = std::min(length, (wall - from[axis]) / direction[axis]);
      const double low = (kBox_m.min()[axis] - from[axis]) / direction[axis];
      const double high = (kBox_m.max()[axis] - from[axis]) / direction[axis];
      enter = std::max(enter, std::min(low, high));
      leave = std::min(leave, std::max(low, high));
    }
    return enter < leave ? std::min(length, enter) : length;
  }

  static View photographed(const core::Rigid3& room_from_camera) {
    View view{camera(), world_from_room() * room_from_camera,
              cv::Mat(kHeight_px, kWidth_px, CV_8UC3), cv::Mat(kHeight_px, kWidth_px, CV_32F)};
    for (int row = 0; row < kHeight_px; ++row) {
      for (int column = 0; column < kWidth_px; ++column) {
        const Eigen::Vector3d bearing = geometry::bearing(view.camera, {column, row});
        const Eigen::Vector3d ray = room_from_camera.rotation * (bearing / bearing.z());
        const double depth_m = length_to_surface(room_from_camera.translation, ray);
        const Eigen::Vector3d hit = room_from_camera.translation + depth_m * ray;
        view.depth_m.at<float>(row, column) = static_cast<float>(depth_m);
        const bool is_floor = hit.z() < 1e-6;
        view.image.at<cv::Vec3b>(row, column) =
            is_floor ? cv::Vec3b(30, 60, 90) : cv::Vec3b(200, 200, 200);
      }
    }
    return view;
  }
};

}  // namespace samewhere::dense
