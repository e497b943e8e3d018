#pragma once

#include <array>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <samewhere/core/file.hpp>
#include <samewhere/input/test_recording.hpp>

namespace samewhere::input {

inline constexpr const char* kLeftSensor =
    "# a camera\n"
    "sensor_type: camera\n"
    "T_BS:\n"
    "  cols: 4\n"
    "  rows: 4\n"
    "  data: [0.0, -1.0, 0.0, -0.02,\n"
    "         1.0, 0.0, 0.0, -0.06,\n"
    "         0.0, 0.0, 1.0, 0.01,\n"
    "         0.0, 0.0, 0.0, 1.0]\n"
    "rate_hz: 20\n"
    "resolution: [32, 24]\n"
    "camera_model: pinhole\n"
    "intrinsics: [30.5, 31.0, 15.5, 11.25] #fu, fv, cu, cv\n"
    "distortion_model: radial-tangential\n"
    "distortion_coefficients: [-0.28, 0.07, 1.9e-04, 1.76e-05]\n";

inline std::string replaced(std::string text, const std::string& old, const std::string& now) {
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return at == std::string::npos ? text : text.replace(at, old.size(), now);
}

// Two cameras, an inertial unit and truth, as in a EuRoC recording; three frames.
class Euroc : public Open {
 protected:
  Euroc() {
    for (const char* name : kNames) {
      write_grey(fmt::format("mav0/cam0/data/{}", name), 50);
      write_grey(fmt::format("mav0/cam1/data/{}", name), 150);
    }
    const std::string list = fmt::format(
        "#timestamp [ns],filename\r\n1403636579763555584,{}\r\n"
        "1403636579813555456,{}\r\n1403636579863555584,{}\r\n",
        kNames[0], kNames[1], kNames[2]);
    folder_.write("mav0/cam0/data.csv", list);
    folder_.write("mav0/cam1/data.csv", list);
    folder_.write("mav0/cam0/sensor.yaml", kLeftSensor);
    folder_.write("mav0/cam1/sensor.yaml",
                  "%YAML:1.0\n---\n" + replaced(kLeftSensor, "-0.02,", "0.09,"));
    folder_.write("mav0/imu0/sensor.yaml",
                  "%YAML:1.0\n"
                  "T_BS:\n  data: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0.5, 0, 0, 0, 1]\n"
                  "gyroscope_noise_density: 1.6968e-04\naccelerometer_noise_density: 2.0e-3\n"
                  "gyroscope_random_walk: 1.9393e-05\n");
    write_imu_samples();
    folder_.write("mav0/state_groundtruth_estimate0/data.csv",
                  "#timestamp, p_RS_R_x [m], ...\n"
                  "1403636579758555392,4.5,-1.75,0.75,0.5,-0.5,0.5,-0.5,0,0,0,0,0,0,0,0,0\n"
                  "1403636579763555584,1,2,3,1,0,0,0,.1,-.2,.3,1e-3,2e-3,3e-3,.04,.05,-.06\n");
  }

  void write_grey(const std::string& name, int grey) const {
    folder_.write_png(name, cv::Mat(24, 32, CV_8UC1, cv::Scalar(grey)));
  }

  // The sample after the last frame belongs to none; two coincide with frames.
  void write_imu_samples() const {
    std::string text = "#timestamp [ns],w_RS_S_x [rad s^-1],...\n";
    for (const char* stamp : {"1403636579758555392", "1403636579763555584", "1403636579768555520",
                              "1403636579813555456", "1403636579900000000"}) {
      text += fmt::format("{},0.1,0.2,0.3,9.5,0.5,-0.5\n", stamp);
    }
    folder_.write("mav0/imu0/data.csv", text);
  }

  std::string complaint_with(const std::string& name, const std::string& content) {
    const std::string before = core::read_file(folder_.at(name));
    folder_.write(name, content);
    const std::string said = complaint_on_opening();
    folder_.write(name, before);
    return said;
  }

  std::string said_with(const std::string& name, const std::string& content) {
    const std::string before = core::read_file(folder_.at(name));
    folder_.write(name, content);
    std::string said = said_on_opening();
    folder_.write(name, before);
    return said;
  }

  static constexpr std::array<const char*, 3> kNames = {
      "1403636579763555584.png", "1403636579813555456.png", "1403636579863555584.png"};
};

}  // namespace samewhere::input
