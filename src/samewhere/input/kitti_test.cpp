#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/input/test_recording.hpp>

namespace samewhere::input {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kCalibration =
    "P0: 30 0 15.5 0 0 31 11.25 0 0 0 1 0\n"
    "P1: 30 0 15.5 -15 0 31 11.25 0 0 0 1 0\n"
    "P2: 30 0 15.5 1.85 0 31 11.25 0.235 0 0 1 0.02\n"
    "P3: 30 0 15.5 -13 0 31 11.25 0.2 0 0 1 0.02\n"
    "Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n";

// A sequence of three frames in the folder sequences/07, poses apart from it.
class Kitti : public testing::Test {
 protected:
  Kitti() {
    for (int camera = 0; camera < 4; ++camera) {
      for (int frame = 0; frame < 3; ++frame) {
        folder_.write_png(fmt::format("sequences/07/image_{}/{:06}.png", camera, frame),
                          cv::Mat(24, 32, CV_8UC1, cv::Scalar(100 * camera + frame % 50)));
      }
    }
    folder_.write("sequences/07/times.txt", "0.000000e+00\n1.0e-01\n2.1e-01\n");
    folder_.write("sequences/07/calib.txt", kCalibration);
    // the second looks to the right
    folder_.write("poses/07.txt",
                  "1 0 0 0 0 1 0 0 0 0 1 0\n"
                  "0 0 1 4 0 1 0 5 -1 0 0 6\n"
                  "1 0 0 1 0 1 0 2 0 0 1 3\n");
  }

  std::filesystem::path sequence() const { return folder_.root() / "sequences/07"; }
  std::unique_ptr<core::Source> open() const { return open_source(sequence(), config_); }
  // What the log says while the sequence is opened; "refused: ..." if it is.
  std::string said_on_opening() const {
    testing::internal::CaptureStdout();
    const std::string error = complaint([this] { open(); });
    const std::string log = testing::internal::GetCapturedStdout();
    return error == "no error" ? log : "refused: " + error;
  }
  std::string said_with(const std::string& name, const std::string& content) const {
    const std::string before = core::read_file(folder_.at(name));
    folder_.write(name, content);
    const std::string said = said_on_opening();
    folder_.write(name, before);
    return said;
  }
  std::string complaint_with(const std::string& name, const std::string& content) const {
    const std::string before = core::read_file(folder_.at(name));
    folder_.write(name, content);
    const std::string said = complaint([this] { open(); });
    folder_.write(name, before);
    return said;
  }

  TestFolder folder_;
  Config config_;
};

TEST_F(Kitti, TheGreyPairComesWithStampsAndCalibration) {
  const auto source = open();
  EXPECT_EQ(source->info().format, "KITTI");
  EXPECT_EQ(source->info().name, "07");
  EXPECT_EQ(source->info().num_frames, 3);
  EXPECT_TRUE(source->info().is_calibrated);
  EXPECT_FALSE(source->info().has_depth);
  ASSERT_TRUE(source->next());
  const auto second = source->next();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->stamp_s, 0.1);
  EXPECT_EQ(second->name, "000001.png");
  ASSERT_EQ(second->images.size(), 2U);
  EXPECT_EQ(second->images[0].at<std::uint8_t>(3, 3), 1);
  EXPECT_EQ(second->images[1].at<std::uint8_t>(3, 3), 101);
  const auto& left = std::get<core::PinholeRadtan>(second->rig->cameras.at(0));
  EXPECT_EQ(left.width_px, 32);
  EXPECT_EQ(left.height_px, 24);
  EXPECT_EQ(left.fx_px, 30.0);
  EXPECT_EQ(left.fy_px, 31.0);
  EXPECT_EQ(left.cx_px, 15.5);
  EXPECT_EQ(left.cy_px, 11.25);
  EXPECT_EQ(left.k1, 0.0);
  EXPECT_EQ(second->rig->body_from_camera[0].translation, Eigen::Vector3d::Zero());
  EXPECT_EQ(second->rig->body_from_camera[1].translation, Eigen::Vector3d(0.5, 0.0, 0.0));
}

TEST_F(Kitti, TheTruthLiesApartOrBesideThePictures) {
  const core::Trajectory truth = open()->truth().trajectory;
  ASSERT_EQ(truth.size(), 3U);
  EXPECT_EQ(truth[1].stamp_s, 0.1);
  EXPECT_EQ(truth[1].world_from_camera.translation, Eigen::Vector3d(4.0, 5.0, 6.0));
  const Eigen::Vector3d ahead = truth[1].world_from_camera.rotation * Eigen::Vector3d::UnitZ();
  EXPECT_LT((ahead - Eigen::Vector3d::UnitX()).norm(), 1e-12);
  folder_.write("sequences/07/poses.txt",
                "1 0 0 9 0 1 0 0 0 0 1 0\n1 0 0 9 0 1 0 0 0 0 1 0\n1 0 0 9 0 1 0 0 0 0 1 0\n");
  EXPECT_EQ(open()->truth().trajectory.at(1).world_from_camera.translation.x(), 9.0);
  std::filesystem::remove(folder_.at("sequences/07/poses.txt"));
  std::filesystem::remove(folder_.at("poses/07.txt"));
  EXPECT_THAT(open()->truth().trajectory, IsEmpty());
}

TEST_F(Kitti, TheColourPairSitsBesideTheGreyOne) {
  std::filesystem::remove_all(sequence() / "image_0");
  const auto source = open();
  const core::Rig rig = *source->next()->rig;
  ASSERT_EQ(rig.cameras.size(), 2U);
  // a point of the world that camera 2 sees at the pixel that P2 says
  const Eigen::Vector3d point(1.0, -2.0, 10.0);
  const Eigen::Vector3d in_camera = inverse(rig.body_from_camera[0]) * point;
  EXPECT_NEAR(30.0 * in_camera.x() / in_camera.z() + 15.5,
              (30.0 * 1.0 + 15.5 * 10.0 + 1.85) / 10.02, 1e-12);
  EXPECT_NEAR(31.0 * in_camera.y() / in_camera.z() + 11.25,
              (31.0 * -2.0 + 11.25 * 10.0 + 0.235) / 10.02, 1e-12);
  EXPECT_NEAR(rig.body_from_camera[1].translation.x() - rig.body_from_camera[0].translation.x(),
              14.85 / 30.0, 1e-12);
  // poses are those of camera 0, the truth is that of camera 2
  EXPECT_EQ(source->truth().trajectory[0].world_from_camera.translation,
            rig.body_from_camera[0].translation);
}

TEST_F(Kitti, OneCameraAloneIsEnough) {
  std::filesystem::remove_all(sequence() / "image_1");
  const auto frame = open()->next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->images.size(), 1U);
  EXPECT_EQ(frame->rig->cameras.size(), 1U);
}

TEST_F(Kitti, AFrameWithoutOneOfItsPicturesIsLeftOut) {
  std::filesystem::remove(sequence() / "image_1/000001.png");
  EXPECT_THAT(said_on_opening(), AllOf(HasSubstr("1 of 3 frames"), HasSubstr("times.txt, stamp 2"),
                                       HasSubstr("image_1/000001.png")));
  const auto source = open();
  EXPECT_EQ(source->info().num_frames, 2);
  source->next();
  EXPECT_EQ(source->next()->stamp_s, 0.21);
  ASSERT_EQ(source->truth().trajectory.size(), 3U);
  EXPECT_EQ(source->truth().trajectory[2].world_from_camera.translation.x(), 1.0);
}

TEST_F(Kitti, PicturesMayHaveAnotherFormatOrLengthOfNumbers) {
  for (int frame = 0; frame < 3; ++frame) {
    std::filesystem::remove(sequence() / fmt::format("image_0/{:06}.png", frame));
    folder_.write_jpeg(fmt::format("sequences/07/image_0/{:010}.JPG", frame),
                       cv::Mat(24, 32, CV_8UC1, cv::Scalar(9)));
  }
  EXPECT_EQ(said_on_opening(), "");
  EXPECT_EQ(open()->info().num_frames, 3);
}

TEST_F(Kitti, AGivenCameraReplacesACalibrationThatCannotBeRead) {
  std::filesystem::remove(sequence() / "calib.txt");
  EXPECT_THAT(said_on_opening(), HasSubstr("refused: "));
  folder_.write("mine.txt", "30 0 15.5\n0 30 11.5\n0 0 1\n");
  config_.camera = folder_.at("mine.txt").string();
  EXPECT_THAT(said_on_opening(), HasSubstr("the second camera is not used"));
  EXPECT_TRUE(open()->info().is_calibrated);
  EXPECT_EQ(open()->info().num_cameras, 1);
  config_ = {.needs_calibration = false};
  EXPECT_THAT(said_on_opening(),
              AllOf(HasSubstr("calib.txt"), HasSubstr("the calibration is not used")));
  EXPECT_FALSE(open()->info().is_calibrated);
}

TEST_F(Kitti, AMissingCalibrationIsNamed) {
  std::filesystem::remove(sequence() / "calib.txt");
  EXPECT_THAT(complaint([this] { open(); }),
              AllOf(HasSubstr("calib.txt"), HasSubstr("No such file")));
}

TEST_F(Kitti, StampsAndPicturesAreCountedAgainstEachOther) {
  const auto said = [this](const std::string& text) {
    return complaint_with("sequences/07/times.txt", text);
  };
  const auto warned = [this](const std::string& text) {
    return said_with("sequences/07/times.txt", text);
  };
  EXPECT_THAT(warned("0\n1\n"),
              AllOf(HasSubstr("times.txt: found 2 stamps"), HasSubstr("image_0/000002.png")));
  EXPECT_THAT(warned("0\n1\n2\n3\n"),
              AllOf(HasSubstr("times.txt, stamp 4"), HasSubstr("000003.png")));
  EXPECT_THAT(warned("0\n1\n2\n3\n4\n5\n6\n"), HasSubstr("refused: "));
  EXPECT_THAT(said(""), HasSubstr("holds no stamp"));
  EXPECT_THAT(said("0\n2\n1\n"), AllOf(HasSubstr("line 3"), HasSubstr("stamp 1 after 2")));
  EXPECT_THAT(said("0\nx\n1\n"), AllOf(HasSubstr("line 2"), HasSubstr("'x'")));
  EXPECT_THAT(said("0\n1 2\n3\n"), AllOf(HasSubstr("line 2"), HasSubstr("found 2 values")));
}

TEST_F(Kitti, ABrokenCalibrationIsNamedWithItsLine) {
  const auto said = [this](const std::string& text) {
    return complaint_with("sequences/07/calib.txt", text);
  };
  EXPECT_THAT(said("P0: 30 0 15.5 0 0 31 11.25 0 0 0 1 0\n"),
              AllOf(HasSubstr("calib.txt: has no line P1:"), HasSubstr("camera 1")));
  EXPECT_THAT(said("\nP0: 30 0 15.5 0 0 31 11.25 0 0 0 1\n"),
              AllOf(HasSubstr("calib.txt, line 2"), HasSubstr("found 11 values, expected 12")));
  EXPECT_THAT(said("P0: -30 0 15.5 0 0 31 11.25 0 0 0 1 0\n"),
              AllOf(HasSubstr("line 1: found -30 0"), HasSubstr("fx > 0")));
  EXPECT_THAT(said("P0: 30 0 nan 0 0 31 11.25 0 0 0 1 0\n"), HasSubstr("'nan'"));
  EXPECT_THAT(said("P0: 30 0 155 0 0 31 11.25 0 0 0 1 0\nP1: 30 0 15 -15 0 31 11 0 0 0 1 0\n"),
              AllOf(HasSubstr("image_0/000000.png: wrong calibration"), HasSubstr("(155, 11.25)")));
}

TEST_F(Kitti, BrokenPosesAreLeftOutAndNamedWithTheirLine) {
  const auto said = [this](const std::string& text) { return said_with("poses/07.txt", text); };
  const std::string good = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  EXPECT_THAT(said(good + good), AllOf(HasSubstr("07.txt: found 2 poses, expected 3")));
  EXPECT_THAT(said(good + good + "1 0 0 0\n"), AllOf(HasSubstr("line 3"), HasSubstr("4 values")));
  EXPECT_THAT(said(good + "2 0 0 0 0 1 0 0 0 0 1 0\n" + good),
              AllOf(HasSubstr("line 2"), HasSubstr("no rigid transform")));
}

}  // namespace
}  // namespace samewhere::input
