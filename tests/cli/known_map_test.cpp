// A run in the map of an earlier run: output, errors, and that no result is lost.

#include <algorithm>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "program.hpp"
#include <samewhere/input/test_folder.hpp>
#include <samewhere/scene/writer_lock.hpp>

namespace samewhere::test {
namespace {

using testing::HasSubstr;

constexpr char kWalk[] = "'twin:office-loop?seed=2' --set twin.num_frames=12";

class KnownMap : public testing::Test {
 protected:
  KnownMap() {
    const Outcome made = run(fmt::format("run {} --out {}", kWalk, in("a")));
    EXPECT_EQ(made.exit_code, 0) << made.err;
  }

  Outcome run(const std::string& arguments) const { return run_program(arguments, folder_.root()); }
  std::filesystem::path path(const std::string& name) const { return folder_.root() / name; }
  std::string in(const std::string& name) const { return quoted(path(name)); }
  void expect_refused(const std::string& arguments, const std::string& why) const {
    const Outcome refused = run(arguments);
    EXPECT_EQ(refused.exit_code, 2) << arguments;
    EXPECT_THAT(refused.err, HasSubstr(why));
    EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
  }

  input::TestFolder folder_;
};

TEST_F(KnownMap, RelocalizationIsReportedAndShown) {
  const Outcome found =
      run(fmt::format("run {} --map {} --localize --out {}", kWalk, in("a/map.sw"), in("b")));
  ASSERT_EQ(found.exit_code, 0) << found.err;
  EXPECT_THAT(found.out, HasSubstr("candidates in the loaded map / recognized"));
  EXPECT_THAT(found.out, testing::ContainsRegex("loop candidates  *0\n"))
      << "what no truth knows does not count";
  EXPECT_THAT(run(fmt::format("ledger {} list --stage evidence", in("b"))).out,
              HasSubstr(" of session 0 "));
  EXPECT_THAT(core::read_file(path("b/report.html")),
              testing::ContainsRegex("\\{\"frame\":[0-9]*,\"session\":0,\"jpeg_base64\":\"/9j/"));
}

TEST_F(KnownMap, AMapThatCannotBeUsedCostsNoEarlierResults) {
  const std::string trajectory = core::read_file(path("a/trajectory.tum"));
  const std::string again = fmt::format("run {} --out {} --force --map", kWalk, in("a"));
  expect_refused(fmt::format("{} {}", again, in("nowhere.sw")), "nowhere.sw: no such file");
  expect_refused(fmt::format("{} {} --set features.num_features=800", again, in("a/map.sw")),
                 "a/map.sw: the map was made with features.num_features = 1000");
  EXPECT_EQ(core::read_file(path("a/trajectory.tum")), trajectory);
  EXPECT_EQ(run(fmt::format("map {} info", in("a/map.sw"))).exit_code, 0);
}

TEST_F(KnownMap, OfAnotherCameraOrAnotherDescriberIsRefused) {
  const std::string again = fmt::format("--map {} --out {}", in("a/map.sw"), in("b"));
  expect_refused(fmt::format("run {} {} --set describe.hog.cell_px=40", kWalk, again),
                 "a/map.sw: the map was made with describer = ");
  expect_refused(fmt::format("run {} {} --set describe.method=autoencoder", kWalk, again),
                 "a/map.sw: the map was made with describer = ");
  ASSERT_EQ(run(fmt::format("twin {} --out {}", kWalk, in("d"))).exit_code, 0);
  const std::string as_recorded = fmt::format("run {} {}", in("d"), again);
  folder_.write("other.txt", "600 0 319.5\n0 600 239.5\n0 0 1\n");
  expect_refused(fmt::format("{} --camera {}", as_recorded, in("other.txt")),
                 "a/map.sw: the map was made with camera 0 = 640 x 480 pixels, focal lengths ");
  EXPECT_FALSE(std::filesystem::exists(path("b")));
  EXPECT_EQ(run(as_recorded).exit_code, 0) << "the same pictures with their own camera";
}

TEST_F(KnownMap, DoesNotGrowByARunWithoutItsDepth) {
  expect_refused(fmt::format("run 'twin:office-loop?seed=2&camera=mono' --set twin.num_frames=12 "
                             "--map {} --out {}",
                             in("a/map.sw"), in("b")),
                 "a/map.sw: the map was made with depth");
  EXPECT_FALSE(std::filesystem::exists(path("b")));
}

TEST_F(KnownMap, AMapThatIsBeingWrittenIsNotRemoved) {
  const scene::WriterLock lock(path("a/map.sw"), scene::WriterLock::File::kIsThere);
  expect_refused(fmt::format("run {} --out {} --force", kWalk, in("a")),
                 "a/map.sw: another program is writing to this map");
  EXPECT_TRUE(std::filesystem::exists(path("a/trajectory.tum")));
}

TEST_F(KnownMap, ResultsDoNotGoIntoAForeignFolder) {
  ASSERT_EQ(run(fmt::format("twin {} --out {}", kWalk, in("d"))).exit_code, 0);
  const std::string frames = core::read_file(path("d/frames.csv"));
  expect_refused(fmt::format("run {} --out {}", kWalk, in("d")),
                 "d/frames.csv: is there already and of no earlier run");
  expect_refused(fmt::format("run {0} --out {0}", in("d")),
                 "d: is the recording itself; expected another folder for the results");
  EXPECT_EQ(core::read_file(path("d/frames.csv")), frames);
  folder_.write("mine/config.yaml", "verify:\n  min_inliers: 60\n");
  expect_refused(
      fmt::format("run {} --config {} --out {}", kWalk, in("mine/config.yaml"), in("mine")),
      "mine/config.yaml: is there already and of no earlier run");
}

}  // namespace
}  // namespace samewhere::test
