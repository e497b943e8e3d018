#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/random.hpp>
#include <samewhere/input/test_euroc.hpp>

namespace samewhere::input {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST_F(Euroc, ABrokenSensorFileIsNamedWithLineAndKey) {
  const auto said = [this](const std::string& old, const std::string& now) {
    return complaint_with("mav0/cam0/sensor.yaml", replaced(kLeftSensor, old, now));
  };
  EXPECT_THAT(said("resolution: [32, 24]", "resolution: [32]"),
              AllOf(HasSubstr("cam0/sensor.yaml, line 11: resolution"), HasSubstr("1 values")));
  EXPECT_THAT(said("[32, 24]", "[32, 24.5]"), HasSubstr("found 24.5"));
  EXPECT_THAT(said("[32, 24]", "[32, 1e30]"), HasSubstr("pixels"));
  EXPECT_THAT(said("[32, 24]", "[[[32, 24]]]"), HasSubstr("plain values"));
  EXPECT_THAT(said("intrinsics", "intrinsic"), HasSubstr("has no intrinsics"));
  EXPECT_THAT(said("[30.5", "[-30.5"), HasSubstr("fx = -30.5"));
  EXPECT_THAT(said("15.5,", "155,"), AllOf(HasSubstr("centre (155, "), HasSubstr("outside")));
  EXPECT_THAT(said("pinhole", "omni"), AllOf(HasSubstr("omni"), HasSubstr("pinhole")));
  EXPECT_THAT(said("radial-tangential", "fov"), HasSubstr("radial-tangential"));
  EXPECT_THAT(said("-0.28, ", ""), HasSubstr("3 distortion values"));
  EXPECT_THAT(said("-0.28, ", "-1e9, "), HasSubstr("k1 = -1000000000"));
  EXPECT_THAT(said("T_BS:", "T_XX:"), HasSubstr("has no T_BS"));
  EXPECT_THAT(said("  data:", "  dat:"), HasSubstr("has no T_BS.data"));
  EXPECT_THAT(said("[0.0, -1.0", "[0.0, -2.0"), HasSubstr("no rigid transform"));
  EXPECT_THAT(said("[0.0, -1.0", "[inf, -1.0"), HasSubstr("'inf'"));
  EXPECT_THAT(said("rate_hz: 20", "rate_hz: [20"), AllOf(HasSubstr("line"), HasSubstr("not YAML")));
  EXPECT_THAT(complaint_with("mav0/cam0/sensor.yaml", "%YAML:1.0"), HasSubstr("sensor.yaml"));
  EXPECT_THAT(complaint_with("mav0/cam0/sensor.yaml", ""), HasSubstr("sensor.yaml"));
  const std::string imu = core::read_file(folder_.at("mav0/imu0/sensor.yaml"));
  EXPECT_THAT(said_with("mav0/imu0/sensor.yaml", replaced(imu, "2.0e-3", "-1")),
              AllOf(HasSubstr("accelerometer_noise_density"), HasSubstr("-1")));
  EXPECT_THAT(said_with("mav0/imu0/sensor.yaml", replaced(imu, "1.9393e-05", "-2")),
              AllOf(HasSubstr("gyroscope_random_walk"), HasSubstr("-2")));
}

TEST_F(Euroc, TheModelGoesByItsOtherNamesToo) {
  for (const char* const name : {"radtan", "plumb_bob", "RadTan", "radial_tangential"}) {
    folder_.write("mav0/cam0/sensor.yaml", replaced(kLeftSensor, "radial-tangential", name));
    EXPECT_EQ(std::get<core::PinholeRadtan>(open()->next()->rig->cameras[0]).k1, -0.28) << name;
  }
  folder_.write("mav0/cam0/sensor.yaml", replaced(kLeftSensor, "pinhole", "Pinhole"));
  EXPECT_EQ(complaint_on_opening(), "no error");
  std::string bare = replaced(kLeftSensor, "distortion_model", "model_of_old");
  bare = replaced(bare, "distortion_coefficients", "coefficients_of_old");
  folder_.write("mav0/cam0/sensor.yaml", bare);
  EXPECT_EQ(std::get<core::PinholeRadtan>(open()->next()->rig->cameras[0]).k1, 0.0);
}

TEST_F(Euroc, AnEquidistantCameraIsAFisheye) {
  folder_.write("mav0/cam0/sensor.yaml", replaced(kLeftSensor, "radial-tangential", "equidistant"));
  const core::Camera camera = open()->next()->rig->cameras[0];
  EXPECT_EQ(std::get<core::KannalaBrandt>(camera).k1, -0.28);
}

TEST_F(Euroc, DamagedSensorFilesNeverCrash) {
  const std::string good = kLeftSensor;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    core::Random random(seed);
    std::string text = good.substr(0, random.index(good.size() + 1));
    for (int i = 0; i < 4 && !text.empty(); ++i) {
      text[random.index(text.size())] = static_cast<char>(random.index(256));
    }
    SCOPED_TRACE(fmt::format("seed {}", seed));
    const std::string said = complaint_with("mav0/cam0/sensor.yaml", text);
    EXPECT_THAT(said, testing::AnyOf("no error", HasSubstr("mav0/cam0/")));
  }
}

TEST_F(Euroc, APictureOfAnotherSizeThanTheCalibrationIsNamed) {
  folder_.write("mav0/cam1/sensor.yaml", replaced(kLeftSensor, "[32, 24]", "[64, 48]"));
  EXPECT_THAT(complaint_on_opening(), AllOf(HasSubstr("mav0/cam1/data"), HasSubstr("32 x 24"),
                                            HasSubstr("calibrated for 64 x 48")));
}

TEST_F(Euroc, ACameraFileOfTheUserReplacesCamera0WhereItSits) {
  folder_.write("mine.txt", kCamera);
  config_.camera = folder_.at("mine.txt").string();
  const core::Rig rig = *open()->next()->rig;
  ASSERT_EQ(rig.cameras.size(), 2U);
  EXPECT_EQ(std::get<core::PinholeRadtan>(rig.cameras[0]).fx_px, 30.0);
  EXPECT_EQ(std::get<core::PinholeRadtan>(rig.cameras[1]).fx_px, 30.5);
  EXPECT_EQ(rig.body_from_camera[0].translation.x(), -0.02);
}

}  // namespace
}  // namespace samewhere::input
