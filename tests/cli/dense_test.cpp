// `samewhere dense` on a run over a rendered room.

#include <algorithm>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "program.hpp"
#include <samewhere/core/tum_file.hpp>
#include <samewhere/dense/test_room.hpp>
#include <samewhere/input/test_folder.hpp>

namespace samewhere::test {
namespace {

// A TUM RGB-D recording of the room and the folder of a run over it in which every second frame is
// a keyframe.
class Dense : public testing::Test {
 protected:
  Dense() {
    const std::vector<dense::View> views = dense::TestRoom::walk();
    std::string rgb;
    std::string depth;
    std::string frames =
        "index,stamp_s,name,status,is_measured,num_inliers,reference_keyframe,...\n";
    core::Trajectory trajectory;
    for (std::size_t i = 0; i < views.size(); ++i) {
      const double stamp_s = 10.0 + 0.1 * static_cast<double>(i);
      rgb += fmt::format("{:.6f} rgb/{}.png\n", stamp_s, i);
      depth += fmt::format("{:.6f} depth/{}.png\n", stamp_s, i);
      folder_.write_png(fmt::format("room/rgb/{}.png", i), views[i].image);
      write_depth(i, views[i].depth_m);
      frames +=
          fmt::format("{},{:.6f},\"a, b\",tracking,1,99,{},0,0,0,0,0,0,1\n", i, stamp_s, i / 2);
      trajectory.push_back({stamp_s, views[i].world_from_camera});
    }
    num_frames_ = views.size();
    folder_.write("room/rgb.txt", rgb);
    folder_.write("room/depth.txt", depth);
    folder_.write("room/camera.txt", "110 0 79.5\n0 110 59.5\n0 0 1\n");
    folder_.write("run/config.yaml", fmt::format("source: \"{}\"\n", path("room").string()));
    folder_.write("run/frames.csv", frames);
    folder_.write("run/trajectory.tum", core::tum_text(trajectory));
  }

  void write_depth(std::size_t i, const cv::Mat& depth_m) const {
    cv::Mat units;
    depth_m.convertTo(units, CV_16U, 5000.0);
    folder_.write_png(fmt::format("room/depth/{}.png", i), units);
  }

  std::filesystem::path path(const std::string& name) const { return folder_.root() / name; }
  Outcome run(const std::string& arguments) const {
    return run_program("dense " + quoted(path("run")) + " --set dense.max_depth_m=6 " + arguments,
                       folder_.root());
  }
  bool is_there(const std::string& name) const { return std::filesystem::exists(path(name)); }

  // One line that names `words`, exit code 2.
  static void expect_clear_error(const Outcome& outcome, const std::vector<std::string>& words) {
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    const auto line = outcome.err.rfind("samewhere: ");  // after the progress of slow work
    ASSERT_NE(line, std::string::npos) << outcome.err;
    const std::string complaint = outcome.err.substr(line);
    EXPECT_EQ(std::count(complaint.begin(), complaint.end(), '\n'), 1) << complaint;
    for (const auto& word : words)
      EXPECT_NE(complaint.find(word), std::string::npos) << word << " in: " << complaint;
  }

  std::size_t num_frames_ = 0;
  input::TestFolder folder_;
};

TEST_F(Dense, WritesAllThreeIntoTheRunAndTheSameBytesAgain) {
  const Outcome first = run("");
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_NE(first.out.find(fmt::format("keyframes  {}\n", num_frames_ / 2)), std::string::npos)
      << first.out;
  const std::vector<std::string> names = {"cloud.ply", "map.pgm", "map.yaml", "map.bt"};
  std::vector<std::string> bytes;
  for (const auto& name : names) bytes.push_back(core::read_file(path("run/" + name)));
  EXPECT_NE(bytes[2].find("image: \"map.pgm\"\n"), std::string::npos);
  EXPECT_EQ(run("").exit_code, 0);
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(core::read_file(path("run/" + names[i])), bytes[i]) << names[i];
  }
}

TEST_F(Dense, FindsTheDepthOfAStereoRunInItsPictures) {
  const auto of_twin = [&](const std::string& arguments) {
    return run_program(arguments + quoted(path("pair")), folder_.root());
  };
  const std::string walk = "twin:office-loop?seed=2&camera=";
  const Outcome made = of_twin(fmt::format("run '{}stereo' --set twin.num_frames=6 --out ", walk));
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const Outcome fused = of_twin("dense ");
  ASSERT_EQ(fused.exit_code, 0) << fused.err;
  for (const char* name : {"pair/cloud.ply", "pair/map.bt"}) EXPECT_TRUE(is_there(name)) << name;
  EXPECT_NE(core::read_file(path("pair/report.html")).find("\"dense\":{"), std::string::npos);
  const std::string of_one_camera = "dense --set 'source=" + walk + "mono' ";
  expect_clear_error(of_twin(of_one_camera), {"neither depth images nor a second camera"});
}

TEST_F(Dense, WritesOnlyWhatIsAskedFor) {
  const Outcome outcome =
      run("--octree " + quoted(path("new/tree.bt")) + " --set dense.octree_voxel_m=0.2");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(is_there("new/tree.bt"));
  EXPECT_FALSE(is_there("run/cloud.ply"));
  EXPECT_FALSE(is_there("run/map.pgm"));
}

TEST_F(Dense, AFolderWithoutARunIsNamed) {
  std::filesystem::remove_all(path("run"));
  expect_clear_error(run(""), {"run/config.yaml", "No such file"});
}

TEST_F(Dense, AMissingTrajectoryIsNamed) {
  std::filesystem::remove(path("run/trajectory.tum"));
  expect_clear_error(run(""), {"run/trajectory.tum", "No such file"});
}

TEST_F(Dense, ATrajectoryOfAnotherRunIsNamed) {
  folder_.write("run/trajectory.tum", "99.5 0 0 0 0 0 0 1\n");
  expect_clear_error(run(""), {"run/trajectory.tum", "none of its 1 poses"});
}

TEST_F(Dense, ABrokenListOfFramesIsNamedWithItsLine) {
  folder_.write("run/frames.csv", "index,stamp_s\n0,10.0\n");
  expect_clear_error(run(""), {"run/frames.csv, line 2", "0,10.0"});
}

TEST_F(Dense, ASourceThatLostItsEndIsNamed) {
  folder_.write("room/rgb.txt", "10.0 rgb/0.png\n10.1 rgb/1.png\n");
  expect_clear_error(run(""), {"room", "ended before frame"});
}

TEST_F(Dense, BlackDepthIsNamed) {
  const cv::Mat black(dense::TestRoom::kHeight_px, dense::TestRoom::kWidth_px, CV_32F,
                      cv::Scalar(0.0));
  for (std::size_t i = 0; i < num_frames_; ++i) write_depth(i, black);
  expect_clear_error(run(""), {"room", "none of its 30 keyframes has depth", "dense.max_depth_m"});
  EXPECT_FALSE(is_there("run/cloud.ply"));
}

TEST_F(Dense, WithoutAFloorThereIsACloudButNoGrid) {
  const Outcome outcome = run("--set dense.min_floor_m2=1000");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("none: no floor was found: "), std::string::npos) << outcome.out;
  EXPECT_TRUE(is_there("run/cloud.ply"));
  EXPECT_FALSE(is_there("run/map.yaml"));
  expect_clear_error(run("--set dense.min_floor_m2=1000 --grid " + quoted(path("plan"))),
                     {"no floor was found", "dense.min_floor_m2"});
}

TEST_F(Dense, AFullDiskIsNamedAndLeavesNoHalfFile) {
  // as if the disk had room for files of 2 KiB only
  const std::string limited =
      fmt::format("trap '' XFSZ; ulimit -f 2; exec '{}' dense {} --set dense.max_depth_m=6 2>{}",
                  SAMEWHERE_PROGRAM, quoted(path("run")), quoted(path("err.txt")));
  folder_.write("limited.sh", limited);
  const int status = std::system(("bash " + quoted(path("limited.sh")) + " >/dev/null").c_str());
  expect_clear_error({WEXITSTATUS(status), "", core::read_file(path("err.txt"))},
                     {"run/cloud.ply", "File too large"});
  for (const auto& entry : std::filesystem::directory_iterator(path("run")))
    EXPECT_EQ(entry.path().string().find("cloud.ply"), std::string::npos) << entry.path();
}

TEST_F(Dense, AnUnknownSettingIsNamed) {
  expect_clear_error(run("--set dense.voxel=1"), {"dense.voxel"});
}

}  // namespace
}  // namespace samewhere::test
