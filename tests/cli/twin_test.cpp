// `samewhere twin` writes folders that others can read.

#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>

#include "program.hpp"
#include <samewhere/input/test_folder.hpp>

namespace samewhere::test {
namespace {

class Twin : public testing::Test {
 protected:
  // pictures that are kept would be compared with themselves
  Twin() { unsetenv("SAMEWHERE_CACHE"); }

  Outcome run(const std::string& arguments) const { return run_program(arguments, folder_.root()); }
  std::filesystem::path path(const std::string& name) const { return folder_.root() / name; }

  Outcome write(const std::string& format, const std::string& more = "") const {
    return run("twin 'twin:office-loop?seed=2' --set twin.num_frames=5 --out " +
               quoted(path(format)) + " --format " + format + " " + more);
  }

  Outcome interrupt(const std::string& arguments, const std::string& is_time) const {
    return interrupt_program("twin twin:office-loop " + arguments, is_time, folder_.root());
  }

  // What the independent format check says.
  std::string check(const std::string& name) const {
    const std::string command = "'" SAMEWHERE_REPOSITORY "/scripts/check-dataset' " +
                                quoted(path(name)) + " >" + quoted(path("check.txt")) + " 2>&1";
    const int status = std::system(command.c_str());
    return (status == 0 ? "good: " : "bad: ") + core::read_file(path("check.txt"));
  }

  input::TestFolder folder_;
};

TEST_F(Twin, ListNamesThePresetsWithALineEach) {
  const Outcome outcome = run("twin --list");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.out.rfind("twin:office-loop ", 0), 0U) << outcome.out;
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 8);
}

TEST_F(Twin, ASheetShowsTheWalkAndABuildingWithoutTwinsHasNoneToShow) {
  const Outcome sheet = run("twin 'twin:office-loop?seed=2' --sheet " + quoted(path("sheet.JPG")));
  ASSERT_EQ(sheet.exit_code, 0) << sheet.err;
  EXPECT_EQ(core::read_file(path("sheet.JPG")).substr(0, 3), "\xff\xd8\xff");
  const Outcome none =
      run("twin twin:office-loop --set twin.num_frames=3 --similarity-sheet x.jpg");
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_NE(none.err.find("has a twin"), std::string::npos) << none.err;
}

TEST_F(Twin, ATumFolderPassesTheFormatCheckAndRuns) {
  const Outcome outcome = write("tum");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("5 frames"), std::string::npos) << outcome.out;
  EXPECT_EQ(check("tum").rfind("good: ", 0), 0U) << check("tum");
  const Outcome slam = run("run " + quoted(path("tum")) + " --out " + quoted(path("out")));
  EXPECT_EQ(slam.exit_code, 0) << slam.err;
  EXPECT_NE(slam.out.find("ATE RMSE"), std::string::npos) << slam.out;
}

TEST_F(Twin, AEurocFolderPassesTheFormatCheckAndIsRecognised) {
  const Outcome outcome = write("euroc");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(check("euroc").rfind("good: ", 0), 0U) << check("euroc");
  const Outcome loops = run("loops " + quoted(path("euroc")) +
                            " --set retrieve.window_frames=2 --out " + quoted(path("out")));
  EXPECT_EQ(loops.exit_code, 0) << loops.err;
  EXPECT_TRUE(std::filesystem::exists(path("out") / "matches.txt"));
  const Outcome slam = run("run " + quoted(path("euroc")) + " --out " + quoted(path("slam")));
  EXPECT_EQ(slam.exit_code, 0) << slam.err;
  EXPECT_TRUE(std::filesystem::exists(path("slam") / "trajectory.tum"));
}

TEST_F(Twin, TheSameWalkIsTheSameBytes) {
  ASSERT_EQ(write("tum").exit_code, 0);
  std::filesystem::rename(path("tum"), path("first"));
  ASSERT_EQ(write("tum").exit_code, 0);
  int num_files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(path("first"))) {
    if (!entry.is_regular_file()) continue;
    const auto name = std::filesystem::relative(entry.path(), path("first"));
    EXPECT_EQ(core::read_file(entry.path()), core::read_file(path("tum") / name)) << name;
    ++num_files;
  }
  EXPECT_GE(num_files, 2 * 5 + 4);
}

TEST_F(Twin, ATakenNameIsToldBeforeAnythingIsRendered) {
  std::filesystem::create_directories(path("tum"));
  const Outcome outcome = run("twin 'twin:hotel?seed=2' --sheet " + quoted(path("sheet.jpg")) +
                              " --out " + quoted(path("new") / "../tum"));
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("is there already"), std::string::npos) << outcome.err;
  // pictures and truth of a hotel would tell how far they have come
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_TRUE(std::filesystem::is_empty(path("tum")));
  for (const char* name : {"sheet.jpg", "new", "tum.partial"}) {
    EXPECT_FALSE(std::filesystem::exists(path(name))) << name;
  }
}

TEST_F(Twin, PicturesAreKeptForThisBuildAlone) {
  ASSERT_EQ(setenv("SAMEWHERE_CACHE", path("cache").c_str(), 1), 0);
  ASSERT_EQ(write("tum").exit_code, 0);
  std::filesystem::path kept;
  for (const auto& entry : std::filesystem::directory_iterator(path("cache"))) kept = entry.path();
  const std::string key = core::read_file(kept / "key.txt");
  EXPECT_EQ(key.rfind("twin:office-loop?seed=2", 0), 0U) << key;
  const std::string hash = key.substr(key.rfind(' ') + 1);
  EXPECT_EQ(hash.size(), 64U) << key;
  EXPECT_EQ(hash.find_first_not_of("0123456789abcdef"), std::string::npos) << key;
  // what is kept is what would be rendered
  std::filesystem::rename(path("tum"), path("first"));
  ASSERT_EQ(write("tum").exit_code, 0);
  for (const char* list : {"rgb", "depth"}) {
    for (const auto& entry : std::filesystem::directory_iterator(path("first") / list)) {
      EXPECT_EQ(core::read_file(entry.path()),
                core::read_file(path("tum") / list / entry.path().filename()));
    }
  }
  // a key that was cut is told, and costs no more than time
  core::write_file(kept / "key.txt", key.substr(0, 9));
  std::filesystem::remove_all(path("tum"));
  const Outcome anew = write("tum");
  EXPECT_EQ(anew.exit_code, 0);
  EXPECT_NE(anew.err.find("key.txt"), std::string::npos) << anew.err;
  EXPECT_NE(anew.err.find("anew"), std::string::npos) << anew.err;
  EXPECT_EQ(core::read_file(kept / "key.txt"), key);
}

// cmake/WriteSourceHash.cmake, over a folder of two sources and a test.
TEST_F(Twin, TheHashOfTheSourcesKnowsEachOfThemButNoTest) {
  folder_.write("src/a.cpp", "int a;\n");
  folder_.write("src/b.hpp", "int b;\n");
  folder_.write("src/a_test.cpp", "int t;\n");
  const auto hashed = [this](const std::string& build) {
    const std::string command = "cmake '-DFOLDERS=" + path("src").string() + "' '-DBUILD=" + build +
                                "' '-DOUT=" + path("hash.cpp").string() +
                                "' -P '" SAMEWHERE_REPOSITORY "/cmake/WriteSourceHash.cmake'";
    EXPECT_EQ(std::system(command.c_str()), 0);
    return core::read_file(path("hash.cpp"));
  };
  const std::string first = hashed("gcc");
  EXPECT_NE(hashed("clang"), first);
  EXPECT_EQ(hashed("gcc"), first);
  folder_.write("src/a_test.cpp", "int u;\n");
  EXPECT_EQ(hashed("gcc"), first);
  folder_.write("src/b.hpp", "int c;\n");
  const std::string second = hashed("gcc");
  EXPECT_NE(second, first);
  folder_.write("src/c.hpp", "");
  EXPECT_NE(hashed("gcc"), second);
}

// cmake/HashedBuild.cmake, in a project of one library.
TEST_F(Twin, TheHashKnowsEveryFlagButNoWarning) {
  folder_.write("project/a.cpp", "");
  folder_.write("project/CMakeLists.txt",
                "cmake_minimum_required(VERSION 3.25)\n"
                "project(one LANGUAGES CXX)\n"
                "add_library(a a.cpp)\n"
                "separate_arguments(OPTIONS)\n"
                "target_compile_options(a PRIVATE ${OPTIONS})\n"
                "list(APPEND CMAKE_MODULE_PATH " SAMEWHERE_REPOSITORY
                "/cmake)\n"
                "include(HashedBuild)\n"
                "hashed_build(a build)\n"
                "file(GENERATE OUTPUT build.txt CONTENT \"${build}\")\n");
  const auto build = [this](const std::string& type, const std::string& options) {
    const std::string command =
        "cmake -S " + quoted(path("project")) + " -B " + quoted(path("build")) +
        " -DCMAKE_CXX_FLAGS_RELEASE=-O3 -DCMAKE_CXX_FLAGS_DEBUG=-O0 -DCMAKE_BUILD_TYPE=" + type +
        " '-DOPTIONS=" + options + "' >/dev/null";
    EXPECT_EQ(std::system(command.c_str()), 0);
    return core::read_file(path("build") / "build.txt");
  };
  const std::string first = build("Release", "-ffp-contract=off -DEXACT");
  EXPECT_NE(build("Debug", "-ffp-contract=off -DEXACT"), first) << first;
  EXPECT_NE(build("Release", "-DEXACT"), first) << first;
  EXPECT_NE(build("Release", "-ffp-contract=off"), first) << first;
  EXPECT_EQ(build("Release", "-Wall -ffp-contract=off -DEXACT"), first);
}

TEST_F(Twin, WrongCallsAreNamed) {
  const auto expect_named = [](const Outcome& outcome, const std::string& words) {
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << words << " in: " << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  };
  expect_named(run("twin"), "expected twin:PRESET or --list");
  expect_named(run("twin twin:office-loop"), "expected --out DIR");
  expect_named(run("twin twin:office-loop --out x --format kitti"), "expected one of: tum, euroc");
  expect_named(run("twin twin:castle --out x"), "castle");
  expect_named(run("twin twin:office-loop --out x --sheet y.png"), "ends in .jpg");
  expect_named(run("twin twin:office-loop --sheet x.jpg --format euroc"),
               "--format requires --out");
  expect_named(run("twin --list --set twin.num_frames=2"), "found --set beside --list");
  expect_named(run("twin --list twin:hotel"), "found SOURCE beside --list");
  for (const char* sheet : {"--sheet ", "--similarity-sheet "}) {
    const Outcome outcome = run("twin twin:office-loop --out " + quoted(path("walk")) + " " +
                                sheet + quoted(path("none") / "x.JPG"));
    expect_named(outcome, "there is no folder " + path("none").string());
    EXPECT_FALSE(std::filesystem::exists(path("walk"))) << "written first";
  }
  std::filesystem::create_directories(path("tum"));
  expect_named(write("tum"), "is there already");
  expect_named(run("twin twin:office-loop --set twin.num_frames=2 --out /proc/walk"), "/proc/walk");
}

TEST_F(Twin, CtrlCLeavesNothing) {
  const std::string partial = quoted(path("cut.partial") / "rgb");
  EXPECT_EQ(interrupt("--out " + quoted(path("cut")), "ls " + partial).exit_code, 130);
  EXPECT_FALSE(std::filesystem::exists(path("cut")));
  EXPECT_FALSE(std::filesystem::exists(path("cut.partial")));
}

TEST_F(Twin, CtrlCEndsASheet) {
  EXPECT_EQ(interrupt("--sheet " + quoted(path("cut.jpg")), "sleep 0.5").exit_code, 130);
  EXPECT_FALSE(std::filesystem::exists(path("cut.jpg")));
}

}  // namespace
}  // namespace samewhere::test
