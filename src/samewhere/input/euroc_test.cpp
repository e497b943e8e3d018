#include <algorithm>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/input/test_euroc.hpp>

namespace samewhere::input {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

TEST_F(Euroc, BothCamerasTheInertialUnitAndTheTruthComeTogether) {
  const auto source = open();
  EXPECT_EQ(source->info().format, "EuRoC");
  EXPECT_EQ(source->info().num_frames, 3);
  EXPECT_FALSE(source->info().has_depth);
  EXPECT_TRUE(source->info().is_calibrated);
  EXPECT_NEAR(source->info().frame_rate_hz, 20.0, 0.01);
  const std::vector<core::Frame> frames = read_all();
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[1].name, kNames[1]);
  EXPECT_NEAR(frames[0].stamp_s, 1403636579.763555584, 3e-7);
  ASSERT_EQ(frames[2].images.size(), 2U);
  EXPECT_EQ(frames[2].images[0].at<std::uint8_t>(3, 3), 50);
  EXPECT_EQ(frames[2].images[1].at<std::uint8_t>(3, 3), 150);
  EXPECT_FALSE(frames[0].depth_m);
  ASSERT_EQ(frames[0].imu_since_last.size(), 2U);
  EXPECT_EQ(frames[0].imu_since_last[1].stamp_s, frames[0].stamp_s);
  EXPECT_EQ(frames[0].imu_since_last[0].angular_velocity_rad_s, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(frames[0].imu_since_last[0].acceleration_m_s2, Eigen::Vector3d(9.5, 0.5, -0.5));
  EXPECT_EQ(frames[1].imu_since_last.size(), 2U);
  EXPECT_THAT(frames[2].imu_since_last, IsEmpty());
}

TEST_F(Euroc, TheRigIsWhatTheSensorFilesSay) {
  const core::Rig rig = *open()->next()->rig;
  ASSERT_EQ(rig.cameras.size(), 2U);
  const auto& left = std::get<core::PinholeRadtan>(rig.cameras[0]);
  EXPECT_EQ(left.width_px, 32);
  EXPECT_EQ(left.height_px, 24);
  EXPECT_EQ(left.fx_px, 30.5);
  EXPECT_EQ(left.fy_px, 31.0);
  EXPECT_EQ(left.cx_px, 15.5);
  EXPECT_EQ(left.cy_px, 11.25);
  EXPECT_EQ(left.k1, -0.28);
  EXPECT_EQ(left.k2, 0.07);
  EXPECT_EQ(left.p1, 1.9e-04);
  EXPECT_EQ(left.p2, 1.76e-05);
  EXPECT_EQ(left.k3, 0.0);
  ASSERT_EQ(rig.body_from_camera.size(), 2U);
  // a quarter turn about z: x of the camera is y of the body
  const Eigen::Vector3d ahead = rig.body_from_camera[0] * Eigen::Vector3d(1.0, 0.0, 0.0);
  EXPECT_LT((ahead - Eigen::Vector3d(-0.02, 0.94, 0.01)).norm(), 1e-12);
  EXPECT_EQ(rig.body_from_camera[1].translation.x(), 0.09);
  ASSERT_TRUE(rig.imu);
  EXPECT_EQ(rig.imu->body_from_imu.translation.z(), 0.5);
  EXPECT_EQ(rig.imu->gyroscope_noise_rad_s_sqrt_hz, 1.6968e-04);
  EXPECT_EQ(rig.imu->accelerometer_noise_m_s2_sqrt_hz, 2.0e-3);
  EXPECT_EQ(rig.imu->gyroscope_bias_walk_rad_s2_sqrt_hz, 1.9393e-05);
  EXPECT_EQ(rig.imu->accelerometer_bias_walk_m_s3_sqrt_hz, 0.0) << "the file does not tell";
}

TEST_F(Euroc, TheTruthIsThePoseOfCamera0) {
  const core::Trajectory truth = open()->truth().trajectory;
  ASSERT_EQ(truth.size(), 2U);
  EXPECT_NEAR(truth[1].stamp_s, 1403636579.763555584, 3e-7);
  // the body does not turn, so the camera sits where T_BS says
  EXPECT_LT((truth[1].world_from_camera.translation - Eigen::Vector3d(0.98, 1.94, 3.01)).norm(),
            1e-12);
  // the quaternion is w x y z: (0.5, -0.5, 0.5, -0.5) turns x to -y
  const Eigen::Vector3d x_of_body =
      Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5) * Eigen::Vector3d::UnitX();
  EXPECT_LT((x_of_body + Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_LT((truth[0].world_from_camera.rotation * -Eigen::Vector3d::UnitY() - x_of_body).norm(),
            1e-12);
}

TEST_F(Euroc, VelocitiesAndBiasesAreThoseOfTheBody) {
  const core::Truth truth = open()->truth();
  ASSERT_EQ(truth.inertial.size(), 2U);
  EXPECT_EQ(truth.inertial[1].stamp_s, truth.trajectory[1].stamp_s);
  EXPECT_EQ(truth.inertial[1].velocity_m_s, Eigen::Vector3d(0.1, -0.2, 0.3));
  EXPECT_EQ(truth.inertial[1].gyroscope_bias_rad_s, Eigen::Vector3d(1e-3, 2e-3, 3e-3));
  EXPECT_EQ(truth.inertial[1].accelerometer_bias_m_s2, Eigen::Vector3d(0.04, 0.05, -0.06));
  // a sensor that lies turned within the body: x of the sensor is y of the body
  const std::string sensor = "mav0/state_groundtruth_estimate0/sensor.yaml";
  folder_.write(sensor, "T_BS: {data: [0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}\n");
  const core::InertialTruth turned = open()->truth().inertial.at(1);
  EXPECT_LT((turned.gyroscope_bias_rad_s - Eigen::Vector3d(-2e-3, 1e-3, 3e-3)).norm(), 1e-15);
  EXPECT_EQ(turned.velocity_m_s, Eigen::Vector3d(0.1, -0.2, 0.3)) << "in the world";
  // one that sits elsewhere moves otherwise
  folder_.write(sensor, "T_BS: {data: [1, 0, 0, 0.1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}\n");
  EXPECT_THAT(open()->truth().inertial, IsEmpty());
}

TEST_F(Euroc, StatesWithoutBiasesArePosesAlone) {
  const std::string row = "1403636579763555584,1,2,3,1,0,0,0";
  for (const char* more : {"", ",.1,-.2,.3", ",.1,-.2,.3,1e-3,2e-3,3e-3,.04,.05", ",0"}) {
    folder_.write("mav0/state_groundtruth_estimate0/data.csv", row + more + "\n");
    const core::Truth truth = open()->truth();
    EXPECT_EQ(truth.trajectory.size(), 1U) << more;
    EXPECT_THAT(truth.inertial, IsEmpty()) << more;
  }
}

TEST_F(Euroc, TheFolderWithinIsTakenToo) {
  folder_.write("same_place.txt", "0 0 0\n0 0 0\n1 0 0\n");
  const auto source = open_source(folder_.root() / "mav0", config_);
  EXPECT_EQ(source->info().format, "EuRoC");
  EXPECT_EQ(source->info().name, folder_.root().filename().string());
  EXPECT_EQ(source->truth().trajectory.size(), 2U);
  ASSERT_TRUE(source->truth().places);
  EXPECT_EQ(source->truth().places->at(2, 0), core::PlaceTruth::kSame);
}

TEST_F(Euroc, OneCameraAloneIsEnough) {
  for (const char* name : {"cam1", "imu0", "state_groundtruth_estimate0"}) {
    std::filesystem::remove_all(folder_.at("mav0/" + std::string(name)));
  }
  const auto source = open();
  EXPECT_THAT(source->truth().trajectory, IsEmpty());
  const auto frame = source->next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->images.size(), 1U);
  EXPECT_EQ(frame->rig->cameras.size(), 1U);
  EXPECT_FALSE(frame->rig->imu);
  EXPECT_THAT(frame->imu_since_last, IsEmpty());
}

TEST_F(Euroc, TheTwoCamerasArePairedByStamp) {
  const std::string right = fmt::format(
      "1403636579762000000,{}\n1403636579815000000,{}\n1403636579840000000,{}\n"
      "1403636579864000000,{}\n",
      kNames[2], kNames[1], kNames[1], kNames[0]);
  folder_.write("mav0/cam1/data.csv", right);
  write_grey(fmt::format("mav0/cam1/data/{}", kNames[2]), 77);
  EXPECT_EQ(read_all().front().images[1].at<std::uint8_t>(0, 0), 77);
  config_.max_stamp_difference_s = 0.001;
  EXPECT_THAT(complaint_on_opening(),
              AllOf(HasSubstr(kNames[0]), HasSubstr("no partner within 0.001 s"),
                    HasSubstr("mav0/cam1/data.csv"), HasSubstr("2 of 3 pictures")));
}

TEST_F(Euroc, AMissingFileIsNamedAndRefusedIfItIsNeeded) {
  const auto said_without = [this](const std::string& name) {
    const std::string before = core::read_file(folder_.at(name));
    std::filesystem::remove(folder_.at(name));
    std::string said = said_on_opening();
    folder_.write(name, before);
    return said;
  };
  for (const char* name :
       {"cam0/sensor.yaml", "cam0/data.csv", "cam1/sensor.yaml", "cam1/data.csv"}) {
    const std::string file = "mav0/" + std::string(name);
    EXPECT_THAT(said_without(file),
                AllOf(HasSubstr("refused: "), HasSubstr(file), HasSubstr("No such file")));
  }
  for (const char* name :
       {"imu0/sensor.yaml", "imu0/data.csv", "state_groundtruth_estimate0/data.csv"}) {
    const std::string file = "mav0/" + std::string(name);
    EXPECT_THAT(said_without(file), AllOf(testing::Not(HasSubstr("refused")), HasSubstr(file),
                                          HasSubstr("No such file")));
  }
  for (const char* camera : {"cam0", "cam1"}) {
    EXPECT_THAT(said_without(fmt::format("mav0/{}/data/{}", camera, kNames[1])),
                AllOf(HasSubstr("1 of 3 p"), HasSubstr(kNames[1]),
                      HasSubstr(fmt::format("mav0/{}/data.csv, line 3", camera)),
                      HasSubstr("does not exist")))
        << camera;
  }
  EXPECT_EQ(said_on_opening(), "");
}

TEST_F(Euroc, AFrameWithoutPartnerIsLeftOutAndCounted) {
  const std::string list = core::read_file(folder_.at("mav0/cam1/data.csv"));
  const std::size_t second = list.find("1403636579813555456,");
  const std::size_t third = list.find("1403636579863555584,");
  EXPECT_THAT(
      said_with("mav0/cam1/data.csv", list.substr(0, second) + list.substr(third)),
      AllOf(HasSubstr("1 of 3 pairs of pictures"), HasSubstr(kNames[1]), HasSubstr("no partner")));
  folder_.write("mav0/cam1/data.csv", list.substr(0, second) + list.substr(third));
  const std::vector<core::Frame> frames = read_all();
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[1].name, kNames[2]);
  EXPECT_EQ(frames[1].images.size(), 2U);
  EXPECT_EQ(frames[1].imu_since_last.size(), 2U) << "of both intervals";
}

TEST_F(Euroc, AGivenCameraReplacesACalibrationThatCannotBeRead) {
  folder_.write("mine.txt", kCamera);
  for (const std::string& sensor : {replaced(kLeftSensor, "pinhole", "omni"), std::string()}) {
    folder_.write("mav0/cam0/sensor.yaml", sensor);
    config_ = {};
    EXPECT_THAT(said_on_opening(), HasSubstr("refused: "));
    config_.camera = folder_.at("mine.txt").string();
    EXPECT_THAT(said_on_opening(),
                AllOf(HasSubstr("the second camera is not used"), HasSubstr("truth of the body")));
    const core::Frame frame = open()->next().value();
    EXPECT_EQ(frame.images.size(), 1U);
    EXPECT_EQ(std::get<core::PinholeRadtan>(frame.rig->cameras.at(0)).fx_px, 30.0);
    config_ = {.needs_calibration = false};
    EXPECT_THAT(said_on_opening(), HasSubstr("the calibration is not used"));
    EXPECT_FALSE(open()->info().is_calibrated);
    EXPECT_EQ(read_all().size(), 3U);
  }
}

TEST_F(Euroc, TablesMayBeWrittenByOtherTools) {
  const std::string list = fmt::format(
      "timestamp,filename\r1403636579763555584,{}\r1403636579813555456,{}\r1403636579863555584,{}"
      "\r",
      kNames[0], kNames[1], kNames[2]);
  EXPECT_EQ(said_with("mav0/cam0/data.csv", "\xef\xbb\xbf" + list), "");
  std::string blanks = list;
  std::replace(blanks.begin(), blanks.end(), ',', ' ');
  EXPECT_EQ(said_with("mav0/cam0/data.csv", blanks), "");
  EXPECT_THAT(said_with("mav0/cam0/data.csv", std::string("\xff\xfe#\0\n\0", 6)),
              AllOf(HasSubstr("refused: "), HasSubstr("UTF-16")));
}

TEST_F(Euroc, ABrokenListIsNamedWithItsLine) {
  const auto said = [this](const std::string& text) {
    return complaint_with("mav0/cam0/data.csv", text);
  };
  EXPECT_THAT(said("#only a header\n"), HasSubstr("lists no image"));
  EXPECT_THAT(said("#\n1403636579.76,a.png\n"),
              AllOf(HasSubstr("data.csv, line 2"), HasSubstr("nanoseconds")));
  EXPECT_THAT(said("99999999999999999999,a.png\n"), HasSubstr("nanoseconds"));
  EXPECT_THAT(said("-5,a.png\n"), HasSubstr("nanoseconds"));
  EXPECT_THAT(said("1403636579763555584\n"), HasSubstr("expected 'stamp,filename'"));
  EXPECT_THAT(said(fmt::format("20,{0}\n10,{0}\n", kNames[0])),
              AllOf(HasSubstr("line 2"), HasSubstr("stamp 10 after 20")));
  EXPECT_THAT(said(fmt::format("20,{0}\n20,{0}\n", kNames[0])), HasSubstr("stamp 20 after 20"));
}

TEST_F(Euroc, BrokenSamplesAndPosesAreLeftOutAndNamed) {
  EXPECT_THAT(said_with("mav0/imu0/data.csv", "10,1,2,3,4,5\n"),
              AllOf(HasSubstr("imu0/data.csv, line 1"), HasSubstr("found 6 values")));
  EXPECT_THAT(said_with("mav0/imu0/data.csv", "10,1,2,3,4,5,nan\n"), HasSubstr("'nan'"));
  const std::string poses = "mav0/state_groundtruth_estimate0/data.csv";
  EXPECT_THAT(said_with(poses, "10,1,2,3,1,0,0\n"), HasSubstr("found 7 values"));
  EXPECT_THAT(said_with(poses, "10,1,2,3,1,0,0,x\n"), HasSubstr("'x'"));
  EXPECT_THAT(said_with(poses,
                        "10,1,2,3,1,0,0,0,1,2,3,0,0,0,0,0,0\n"
                        "11,1,2,3,1,0,0,0,1,2,3,0,0,0,0,0\n"),
              AllOf(HasSubstr("line 2"), HasSubstr("found 16 values")));
  EXPECT_THAT(said_with(poses, "10,1,2,3,2,0,0,0\n"),
              AllOf(HasSubstr("line 1"), HasSubstr("norm 2")));
}

}  // namespace
}  // namespace samewhere::input
