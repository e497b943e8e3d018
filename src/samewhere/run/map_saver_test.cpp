#include <cmath>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <samewhere/describe/describer.hpp>
#include <samewhere/run/map_saver.hpp>

namespace samewhere::run {
namespace {

constexpr std::uint64_t kChecksum = 7;

core::PinholeRadtan camera() {
  return {.width_px = 640,
          .height_px = 480,
          .fx_px = 517.3,
          .fy_px = 516.5,
          .cx_px = 318.6,
          .cy_px = 255.3,
          .k1 = 0.2624,
          .k2 = -0.9531,
          .p1 = -0.0054,
          .p2 = 0.0026,
          .k3 = 1.1633};
}

core::Rig pair_of(const core::PinholeRadtan& right) {
  core::Rig rig;
  rig.cameras = {camera(), right};
  rig.body_from_camera = {core::Rigid3{}, {Eigen::Quaterniond::Identity(), {0.12, 0.0, 0.0}}};
  return rig;
}

scene::MapHeader header_of(const core::Rig& rig) { return map_header({}, rig, kChecksum); }

// The names under which two headers differ.
std::set<std::string> differences(const scene::MapHeader& a, const scene::MapHeader& b) {
  std::set<std::string> names;
  for (const auto& [name, value] : a)
    if (!b.contains(name) || b.at(name) != value) names.insert(name);
  for (const auto& [name, value] : b)
    if (!a.contains(name)) names.insert(name);
  return names;
}

using Names = std::set<std::string>;

TEST(MapHeader, EveryNumberOfACameraToItsLastBitMakesItAnother) {
  const scene::MapHeader header = header_of(pair_of(camera()));
  EXPECT_EQ(header, header_of(pair_of(camera())));
  using Camera = core::PinholeRadtan;
  for (int Camera::*const size : {&Camera::width_px, &Camera::height_px}) {
    Camera other = camera();
    ++(other.*size);
    EXPECT_EQ(differences(header, header_of(pair_of(other))), Names{"camera 1"});
  }
  for (double Camera::*const number :
       {&Camera::fx_px, &Camera::fy_px, &Camera::cx_px, &Camera::cy_px, &Camera::k1, &Camera::k2,
        &Camera::p1, &Camera::p2, &Camera::k3}) {
    Camera other = camera();
    other.*number = std::nextafter(other.*number, 1e9);
    EXPECT_EQ(differences(header, header_of(pair_of(other))), Names{"camera 1"})
        << camera().*number;
  }
}

TEST(MapHeader, WhereACameraSitsAndHowManyThereAreMakesItAnother) {
  const scene::MapHeader header = header_of(pair_of(camera()));
  for (int i = 0; i < 6; ++i) {
    core::Rig moved = pair_of(camera());
    moved.body_from_camera[1] =
        moved.body_from_camera[1] * core::exp_r3so3(1e-9 * core::Vector6d::Unit(i));
    EXPECT_EQ(differences(header, header_of(moved)), Names{"body_from_camera 1"}) << i;
  }
  core::Rig one = pair_of(camera());
  one.cameras.pop_back();
  one.body_from_camera.pop_back();
  EXPECT_EQ(differences(header, header_of(one)),
            (Names{"body_from_camera 1", "camera 1", "number of cameras"}));
}

TEST(MapHeader, EverySettingOfTheFeaturesMakesItAnother) {
  const core::Rig rig = pair_of(camera());
  const scene::MapHeader header = header_of(rig);
  const std::map<std::string, std::string> others = {{"features.denoise", "true"},
                                                     {"features.equalize", "true"},
                                                     {"features.num_features", "1001"},
                                                     {"features.num_levels", "7"},
                                                     {"features.scale_factor", "1.2000001"},
                                                     {"features.min_corner_contrast", "8"},
                                                     {"features.cell_px", "41"},
                                                     {"features.virtual_baseline_m", "0.0750001"},
                                                     {"features.max_distance_bits", "63"},
                                                     {"features.max_ratio", "0.8000001"}};
  for (const auto& [name, value] : header)
    EXPECT_EQ(name.starts_with("features."), others.contains(name)) << name;
  for (const auto& [name, value] : others) {
    pipeline::Config config;
    core::set_config(config, name + "=" + value);
    EXPECT_EQ(differences(header, map_header(config, rig, kChecksum)), Names{name});
  }
  pipeline::Config config;
  ++config.verify.min_inliers;
  EXPECT_EQ(differences(header, map_header(config, rig, kChecksum)), Names{})
      << "settings of the verification may change";
}

TEST(MapHeader, AnotherNetworkOrAnotherSettingOfTheDescriberMakesItAnother) {
  const core::Rig rig = pair_of(camera());
  const scene::MapHeader header = header_of(rig);
  EXPECT_EQ(differences(header, map_header({}, rig, kChecksum + 1)), Names{"describer"})
      << "a network of other weights under the same name";
  pipeline::Config coarse;
  coarse.describe.hog.cell_px *= 2;
  const auto checksum = [](const pipeline::Config& config) {
    return describe::make_describer(config.describe)->checksum();
  };
  EXPECT_EQ(
      differences(map_header({}, rig, checksum({})), map_header(coarse, rig, checksum(coarse))),
      Names{"describer"});
}

}  // namespace
}  // namespace samewhere::run
