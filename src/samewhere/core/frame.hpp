#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include <samewhere/core/ids.hpp>
#include <samewhere/core/rig.hpp>

namespace samewhere::core {

// One inertial measurement in the frame of the inertial unit.
struct ImuSample {
  double stamp_s = 0.0;
  Eigen::Vector3d angular_velocity_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_m_s2 = Eigen::Vector3d::Zero();
};

// Sensor data of one moment. Images are shared and never written after the frame is made.
struct Frame {
  FrameId id;
  double stamp_s = 0.0;
  std::string name;  // how the source calls it, for messages: the image's file name
  std::shared_ptr<const Rig> rig;
  std::vector<cv::Mat> images;  // one per camera; 8-bit grey or BGR, rows x columns
  std::optional<cv::Mat>
      depth_m;  // of camera 0, same size, 32-bit float metres along the optical axis, 0 = unknown
  std::vector<ImuSample> imu_since_last;
  // Of a live source: how many came between the frame before and this one and were not given,
  // because a newer one was there.
  int num_dropped_before = 0;
};

}  // namespace samewhere::core
