// `samewhere export` of a small run, to each format.

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "program.hpp"
#include <samewhere/input/image_file.hpp>
#include <samewhere/input/test_folder.hpp>

namespace samewhere::test {
namespace {

using testing::HasSubstr;

class Export : public testing::Test {
 protected:
  std::filesystem::path run() const { return path("run"); }
  std::filesystem::path path(const std::string& name) const { return folder_.root() / name; }
  bool is_there(const std::string& name) const { return std::filesystem::exists(path(name)); }
  Outcome exported(const std::string& arguments) const {
    return run_program("export " + quoted(run()) + " --to " + arguments, folder_.root());
  }
  void expect_refused(const std::string& arguments, const std::string& words) const {
    const Outcome refused = exported(arguments);
    EXPECT_EQ(refused.exit_code, 2) << arguments;
    EXPECT_THAT(refused.err, HasSubstr(words));
  }

  void expect_colmap() const;
  void expect_nerfstudio() const;
  void expect_files() const;
  void expect_refusals() const;

  input::TestFolder folder_;
};

void Export::expect_colmap() const {
  const Outcome made = exported("colmap");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_THAT(made.out, HasSubstr("mean reprojection error"));
  EXPECT_THAT(core::read_file(path("run/colmap/sparse/0/cameras.txt")), HasSubstr("1 OPENCV 640"));
  EXPECT_GT(core::read_file(path("run/colmap/sparse/0/points3D.txt")).size(), 1000U);
  const std::string images = core::read_file(path("run/colmap/sparse/0/images.txt"));
  std::size_t num_pictures = 0;
  for (const auto& entry : std::filesystem::directory_iterator(path("run/colmap/images"))) {
    EXPECT_THAT(images, HasSubstr(" 1 " + entry.path().filename().string() + "\n"));
    ++num_pictures;
  }
  EXPECT_GE(num_pictures, 2U);
  expect_refused("colmap", "holds an earlier export");
  const Outcome again = exported("colmap --force --binary --undistort");
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.out, HasSubstr("PINHOLE"));
  EXPECT_TRUE(is_there("run/colmap/sparse/0/points3D.bin"));
  EXPECT_FALSE(is_there("run/colmap/sparse/0/points3D.txt")) << "of the earlier export";
}

void Export::expect_nerfstudio() const {
  const Outcome made = exported("nerfstudio --out " + quoted(path("nerf")));
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const auto json = nlohmann::json::parse(core::read_file(path("nerf/transforms.json")));
  ASSERT_GE(json.at("frames").size(), 2U);
  for (const auto& frame : json.at("frames")) {
    const auto picture = input::read_image(path("nerf") / frame.at("file_path"));
    EXPECT_EQ(picture.cols, json.at("w").get<int>());
    const auto depth_m = input::read_depth(path("nerf") / frame.at("depth_file_path"), 1000.0);
    EXPECT_EQ(depth_m.size(), picture.size());
  }
  EXPECT_EQ(core::read_file(path("nerf") / json.at("ply_file_path")),
            core::read_file(path("run/map.ply")));
}

void Export::expect_files() const {
  for (const std::string format : {"tum", "kitti", "g2o", "ply", "las"}) {
    const Outcome made = exported(format + " --out " + quoted(path("as." + format)));
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  EXPECT_EQ(core::read_file(path("as.tum")), core::read_file(path("run/trajectory.tum")));
  EXPECT_EQ(core::read_file(path("as.ply")), core::read_file(path("run/map.ply")));
  EXPECT_THAT(core::read_file(path("as.g2o")), HasSubstr("EDGE_SE3:QUAT 0 1 "));
  EXPECT_THAT(core::read_file(path("as.las")), testing::StartsWith("LASF"));
  const Outcome messages = exported("mcap");
  ASSERT_EQ(messages.exit_code, 0) << messages.err;
  const Outcome info = run_program("info " + quoted(path("run/export.mcap")), folder_.root());
  EXPECT_EQ(info.exit_code, 0) << info.err;
  for (const char* topic : {"/tf_static", "/pose", "/path", "nav_msgs/OccupancyGrid", "/map_points",
                            "/diagnostics", "/camera/image/compressed", "/camera/camera_info"})
    EXPECT_THAT(info.out, HasSubstr(topic));
  ASSERT_EQ(exported("las").exit_code, 0);
  EXPECT_EQ(core::read_file(path("run/export.las")), core::read_file(path("as.las")));
  expect_refused("las", "export.las: is there already");
}

void Export::expect_refusals() const {
  expect_refused("obj", "--to = obj: expected one of colmap, nerfstudio, mcap, tum");
  expect_refused("tum --binary", "--binary: has no meaning for --to tum");
  expect_refused("las --undistort", "--undistort: has no meaning for --to las");
  expect_refused("tum --session 1", "expected one of 0 to 0");
  std::filesystem::copy(run(), path("moved"), std::filesystem::copy_options::recursive);
  folder_.write("moved/config.yaml", "source: \"" + path("nowhere").string() + "\"\n");
  const Outcome gone =
      run_program("export " + quoted(path("moved")) + " --to colmap --out " + quoted(path("none")),
                  folder_.root());
  EXPECT_EQ(gone.exit_code, 2);
  EXPECT_THAT(gone.err, HasSubstr("nowhere"));
  EXPECT_FALSE(is_there("none")) << "no folder without a picture";
}

TEST_F(Export, WritesARunInEachFormatAndRefusesWhatHasNoMeaning) {
  const Outcome made =
      run_program("run 'twin:office-loop?seed=2' --set twin.num_frames=12 --out " + quoted(run()),
                  folder_.root());
  ASSERT_EQ(made.exit_code, 0) << made.err;
  expect_colmap();
  expect_nerfstudio();
  expect_files();
  expect_refusals();
}

}  // namespace
}  // namespace samewhere::test
