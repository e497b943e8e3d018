// The map file of a run: complete after kill -9, an error if it cannot be written, exports.

#include <csignal>
#include <thread>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "program.hpp"
#include <samewhere/input/test_folder.hpp>
#include <samewhere/scene/map_file.hpp>

namespace samewhere::test {
namespace {

using testing::HasSubstr;

class MapOfARun : public testing::Test {
 protected:
  Outcome run(const std::string& arguments) const { return run_program(arguments, folder_.root()); }
  std::filesystem::path path(const std::string& name) const { return folder_.root() / name; }

  // The process id of the program on a recording too long to end before it is killed.
  pid_t start_long_run(const std::filesystem::path& out) const {
    const pid_t child = fork();
    if (child != 0) return child;
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    execl(SAMEWHERE_PROGRAM, SAMEWHERE_PROGRAM, "run", "twin:office-loop?seed=2", "--set",
          "twin.num_frames=150", "--out", out.c_str(), nullptr);
    _exit(127);
  }

  // Number of keyframes in the file; 0 if there is no file yet.
  static std::size_t num_keyframes(const std::filesystem::path& map) {
    try {
      return scene::MapFile::open(map).load().map.keyframes.size();
    } catch (const core::InputError&) {
      return 0;
    }
  }

  input::TestFolder folder_;
};

TEST_F(MapOfARun, IsThereUpToTheLastKeyframeAfterKill9) {
  const pid_t program = start_long_run(path("cut"));
  std::size_t seen = 0;
  for (int i = 0; i < 2000 && seen < 5; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    seen = num_keyframes(path("cut/map.sw"));
  }
  kill(program, SIGKILL);
  int status = 0;
  ASSERT_EQ(waitpid(program, &status, 0), program);
  ASSERT_TRUE(WIFSIGNALED(status)) << "the run was over before it could be killed";
  ASSERT_TRUE(std::filesystem::exists(path("cut/map.sw-wal")));
  const scene::StoredMap stored = scene::MapFile::open(path("cut/map.sw")).load();
  EXPECT_GE(stored.map.keyframes.size(), seen);
  EXPECT_GE(seen, 5U);
  EXPECT_GE(stored.extras.frames.back().frame, stored.map.keyframes.back().view.frame);
  EXPECT_THAT(run("map " + quoted(path("cut/map.sw")) + " info").out, HasSubstr("keyframes"));
}

// 2 MB: enough for the report, not for the map.
TEST_F(MapOfARun, AFullDiskIsSaidAndTheOtherFilesAreWritten) {
  core::write_file(path("limited.sh"),
                   "ulimit -f 2000\n'" + std::string(SAMEWHERE_PROGRAM) +
                       "' run 'twin:office-loop?seed=2' --set twin.num_frames=60 --out " +
                       quoted(path("full")) + " >/dev/null 2>" + quoted(path("err.txt")) + "\n");
  const int status = std::system(("bash " + quoted(path("limited.sh"))).c_str());
  EXPECT_EQ(WEXITSTATUS(status), 2);
  const std::string err = core::read_file(path("err.txt"));
  EXPECT_THAT(err, HasSubstr("samewhere: " + path("full/map.sw").string() + ": cannot be"));
  for (const char* file : {"trajectory.tum", "frames.csv", "loops.json", "map.ply", "report.html"})
    EXPECT_TRUE(std::filesystem::exists(path("full") / file)) << file;
}

TEST_F(MapOfARun, IsExportedAsTheRunWroteItself) {
  const Outcome made =
      run("run 'twin:office-loop?seed=2' --set twin.num_frames=12 --out " + quoted(path("a")));
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_THAT(core::read_file(path("a/timing.json")), HasSubstr("\"save\""));
  scene::MapFile file = scene::MapFile::open(path("a/map.sw"));
  const scene::MapVersion kept = file.load().map;
  for (std::size_t i = 0; i < kept.keyframes.size(); ++i)
    EXPECT_TRUE(file.thumbnail(kept.keyframes[i].view.frame)) << "picture of keyframe " << i;
  const std::string map = "map " + quoted(path("a/map.sw"));
  const Outcome info = run(map + " info");
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_THAT(info.out, HasSubstr("features.num_features"));
  const Outcome exported =
      run(map + " export --ply " + quoted(path("p.ply")) + " --tum " + quoted(path("t.tum")) +
          " --kitti " + quoted(path("k.txt")) + " --g2o " + quoted(path("g.g2o")));
  ASSERT_EQ(exported.exit_code, 0) << exported.err;
  EXPECT_EQ(core::read_file(path("t.tum")), core::read_file(path("a/trajectory.tum")));
  EXPECT_EQ(core::read_file(path("p.ply")), core::read_file(path("a/map.ply")));
  const std::string kitti = core::read_file(path("k.txt"));
  EXPECT_EQ(std::count(kitti.begin(), kitti.end(), '\n'), 12);
  EXPECT_THAT(core::read_file(path("g.g2o")), HasSubstr("EDGE_SE3:QUAT 0 1 "));

  const Outcome nothing = run(map + " export --session 0");
  EXPECT_EQ(nothing.exit_code, 2);
  EXPECT_THAT(nothing.err, HasSubstr("nothing to write; expected --ply"));
  const Outcome twice =
      run(map + " export --ply " + quoted(path("one")) + " --tum " + quoted(path("a/../one")));
  EXPECT_EQ(twice.exit_code, 2);
  EXPECT_THAT(twice.err, HasSubstr("named twice"));
  EXPECT_FALSE(std::filesystem::exists(path("one")));
  const Outcome half =
      run(map + " export --tum " + quoted(path("half.tum")) + " --g2o /proc/none/g.g2o");
  EXPECT_EQ(half.exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(path("half.tum"))) << "all or none";

  const Outcome missing = run("map " + quoted(path("nowhere.sw")) + " info");
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.err, HasSubstr("nowhere.sw: no such file; expected a samewhere map"));
}

}  // namespace
}  // namespace samewhere::test
