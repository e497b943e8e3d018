#include <cstring>
#include <sstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/map/test_map.hpp>
#include <samewhere/run/export_colmap.hpp>
#include <samewhere/run/export_model.hpp>
#include <samewhere/run/export_nerfstudio.hpp>

namespace samewhere::run {
namespace {

using testing::HasSubstr;

constexpr int kNumViews = 6;

scene::MapVersion map_to_export() { return map::test_map(features::test_world(1), kNumViews); }

// The mean reprojection error of a point, by its definition.
double reprojection_error_px(const ExportedModel& model, const ExportedPoint& point) {
  double sum_px = 0.0;
  for (const ExportedObservation& observation : point.observations) {
    const ExportedView& view = model.views[observation.view];
    const auto pixel =
        geometry::project(model.camera, inverse(view.world_from_camera) * point.in_world);
    sum_px += (*pixel - view.features[observation.feature].pixel).norm();
  }
  return sum_px / static_cast<double>(point.observations.size());
}

TEST(ExportModel, TracksNameTheFeaturesThatObserveThePoint) {
  const ExportedModel model = model_of(map_to_export(), 0, {{640, 480}, false});
  ASSERT_EQ(model.views.size(), static_cast<std::size_t>(kNumViews));
  ASSERT_GT(model.points.size(), 100U);
  std::size_t num_features = 0;
  for (const ExportedView& view : model.views) num_features += view.features.size();
  EXPECT_EQ(num_features, num_observations(model)) << "each feature observes one point";
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    const ExportedPoint& point = model.points[i];
    EXPECT_GE(point.observations.size(), 2U);
    for (const ExportedObservation& observation : point.observations)
      ASSERT_EQ(model.views[observation.view].features[observation.feature].point, i);
    EXPECT_NEAR(point.error_px, reprojection_error_px(model, point), 1e-9);
  }
  EXPECT_LT(mean_error_px(model), 1.0) << "pixels have a noise of 0.3 px";
}

TEST(ExportModel, PicturesOfHalfTheSizeHaveHalfTheError) {
  const scene::MapVersion map = map_to_export();
  const ExportedModel whole = model_of(map, 0, {{640, 480}, false});
  const ExportedModel half = model_of(map, 0, {{320, 240}, false});
  EXPECT_EQ(half.camera.width_px, 320);
  EXPECT_DOUBLE_EQ(half.camera.fx_px, whole.camera.fx_px / 2);
  EXPECT_DOUBLE_EQ(half.camera.cx_px + 0.5, (whole.camera.cx_px + 0.5) / 2);
  EXPECT_NEAR(mean_error_px(half), mean_error_px(whole) / 2, 1e-9);
}

TEST(ExportModel, RefusesPicturesOfAnotherShapeAndSessionsWithoutKeyframe) {
  const scene::MapVersion map = map_to_export();
  EXPECT_THROW(model_of(map, 0, {{640, 360}, false}), core::InputError);
  EXPECT_THROW(model_of(map, 1, {{640, 480}, false}), core::InputError);
}

// The map as a lens with distortion would have seen it.
scene::MapVersion map_with_distortion() {
  scene::MapVersion map = map_to_export();
  core::Rig rig = *map.keyframes[0].view.rig;
  auto& camera = std::get<core::PinholeRadtan>(rig.cameras[0]);
  camera.k1 = -0.05;
  camera.p1 = 0.001;
  const auto distorted_rig = std::make_shared<const core::Rig>(rig);
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    features::View& view = map.keyframes.edit(i).view;
    auto features = std::make_shared<features::Features>(*view.features);
    for (std::size_t k = 0; k < features->raw_px.size(); ++k) {
      const Eigen::Vector3d ray =
          geometry::bearing_of_undistorted(camera, features->undistorted_px[k].cast<double>());
      features->raw_px[k] = geometry::project(camera, ray)->cast<float>();
    }
    view.rig = distorted_rig;
    view.features = features;
  }
  return map;
}

TEST(ExportModel, UndistortedPixelsBelongToAPinhole) {
  const scene::MapVersion map = map_with_distortion();
  const ExportedModel as_taken = model_of(map, 0, {{640, 480}, false});
  const ExportedModel ideal = model_of(map, 0, {{640, 480}, true});
  EXPECT_STREQ(colmap_camera_model(as_taken.camera), "OPENCV");
  EXPECT_STREQ(colmap_camera_model(ideal.camera), "PINHOLE");
  EXPECT_DOUBLE_EQ(ideal.camera.fx_px, as_taken.camera.fx_px);
  EXPECT_NE(as_taken.views[0].features[0].pixel, ideal.views[0].features[0].pixel);
  EXPECT_LT(mean_error_px(as_taken), 1.0);
  EXPECT_LT(mean_error_px(ideal), 1.0);
}

// Rows of a text file of COLMAP without comments.
std::vector<std::vector<double>> colmap_rows(const std::string& text) {
  std::vector<std::vector<double>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("#")) continue;
    std::istringstream words(line);
    rows.emplace_back();
    for (double value = 0.0; words >> value;) rows.back().push_back(value);
  }
  return rows;
}

TEST(ExportColmap, PixelsAreCountedFromTheCornerAndPosesLeadToTheCamera) {
  const ExportedModel model = model_of(map_to_export(), 0, {{640, 480}, false});
  const ColmapFiles files = colmap_text(model);
  EXPECT_THAT(files.cameras, HasSubstr("\n1 PINHOLE 640 480 500 500 320.5 240.5\n"));
  EXPECT_THAT(files.images, HasSubstr(" 1 frame-000003.png\n"));
  const auto images = colmap_rows(files.images);
  const auto points = colmap_rows(files.points);
  ASSERT_EQ(points.size(), model.points.size());
  const std::vector<double>& point = points.at(5);  // id x y z r g b error (image feature)...
  ASSERT_GE(point.size(), 12U);
  for (std::size_t k = 8; k + 1 < point.size(); k += 2) {
    const auto row = static_cast<std::size_t>(2 * (point[k] - 1));
    const std::vector<double>& pose = images.at(row);  // id qw qx qy qz tx ty tz camera
    const Eigen::Vector3d in_camera = Eigen::Quaterniond(pose[1], pose[2], pose[3], pose[4]) *
                                          Eigen::Vector3d(point[1], point[2], point[3]) +
                                      Eigen::Vector3d(pose[5], pose[6], pose[7]);
    const auto feature = static_cast<std::size_t>(3 * point[k + 1]);  // x y point
    const std::vector<double>& features = images.at(row + 1);
    EXPECT_EQ(features.at(feature + 2), point[0]);
    EXPECT_NEAR(features.at(feature), 500 * in_camera.x() / in_camera.z() + 320.5, 3.0);
    EXPECT_NEAR(features.at(feature + 1), 500 * in_camera.y() / in_camera.z() + 240.5, 3.0);
  }
}

template <class T>
T colmap_value(const std::string& bytes, std::size_t at) {
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

TEST(ExportColmap, BinaryFilesHaveTheSizesOfTheirRows) {
  ExportedModel model = model_of(map_to_export(), 0, {{640, 480}, false});
  const ColmapFiles files = colmap_binary(model);
  EXPECT_EQ(files.cameras.size(), 8U + 4 + 4 + 8 + 8 + 4 * 8);
  EXPECT_EQ(colmap_value<std::int32_t>(files.cameras, 12), 1) << "PINHOLE";
  EXPECT_EQ(colmap_value<double>(files.cameras, 48), 320.5);
  EXPECT_EQ(files.images.size(), 8 + model.views.size() * (4 + 7 * 8 + 4 + 17 + 8) +
                                     num_observations(model) * (2 * 8 + 8))
      << "17: frame-000000.png and its end";
  EXPECT_EQ(files.points.size(),
            8 + model.points.size() * (8 + 3 * 8 + 3 + 8 + 8) + num_observations(model) * 8);
  EXPECT_EQ(colmap_value<std::uint64_t>(files.points, 0), model.points.size());
  EXPECT_EQ(colmap_value<double>(files.points, 16), model.points[0].in_world.x());
  model.camera.k3 = 0.01;
  const std::string wide = colmap_binary(model).cameras;
  EXPECT_EQ(colmap_value<std::int32_t>(wide, 12), 6) << "FULL_OPENCV";
  EXPECT_EQ(wide.size(), 8U + 4 + 4 + 8 + 8 + 12 * 8);
}

TEST(ExportNerfstudio, CamerasLookAlongTheirNegativeZ) {
  const ExportedModel model = model_of(map_with_distortion(), 0, {{640, 480}, false});
  std::vector<bool> has_depth(model.views.size(), true);
  has_depth[1] = false;
  const auto json = nlohmann::json::parse(
      transforms_json(model, has_depth, {"images", "depth", "sparse_points.ply"}));
  EXPECT_EQ(json.at("camera_model"), "OPENCV");
  EXPECT_EQ(json.at("cx"), 320.5);
  EXPECT_EQ(json.at("k1"), -0.05);
  EXPECT_EQ(json.at("ply_file_path"), "sparse_points.ply");
  const auto& frames = json.at("frames");
  ASSERT_EQ(frames.size(), model.views.size());
  EXPECT_EQ(frames[0].at("file_path"), "images/frame-000000.png");
  EXPECT_EQ(frames[0].at("depth_file_path"), "depth/frame-000000.png");
  EXPECT_FALSE(frames[1].contains("depth_file_path"));
  const Eigen::Matrix4d expected = model.views[2].world_from_camera.matrix();
  for (int row = 0; row < 4; ++row) {
    const auto& values = frames[2].at("transform_matrix").at(static_cast<std::size_t>(row));
    EXPECT_EQ(values.at(0).get<double>(), expected(row, 0)) << "x stays";
    EXPECT_EQ(values.at(1).get<double>(), -expected(row, 1)) << "y points up";
    EXPECT_EQ(values.at(2).get<double>(), -expected(row, 2)) << "z points back";
    EXPECT_EQ(values.at(3).get<double>(), expected(row, 3));
  }
}

}  // namespace
}  // namespace samewhere::run
