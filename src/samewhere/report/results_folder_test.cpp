#include <filesystem>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/report/results_folder.hpp>
#include <samewhere/scene/writer_lock.hpp>

namespace samewhere::report {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class ResultsFolderTest : public testing::Test {
 protected:
  ResultsFolderTest() {
    fs::create_directories(root_ / "recording");
    fs::create_directories(root_ / "earlier");
    core::write_file(earlier("config.yaml"), "source: \"walk\"\n");
    for (const char* name : {"trajectory.tum", "map.sw", "notes.txt", "map.ply.partial-17-0"})
      core::write_file(earlier(name), "old");
  }
  ~ResultsFolderTest() override { fs::remove_all(root_); }
  ResultsFolderTest(const ResultsFolderTest&) = delete;
  ResultsFolderTest& operator=(const ResultsFolderTest&) = delete;

  fs::path earlier(const char* name) const { return root_ / "earlier" / name; }
  ResultsPlace place(const fs::path& folder, bool replaces_earlier = false) const {
    return {.folder = folder.empty() ? folder : root_ / folder,
            .name = root_ / "runs" / "walk",
            .replaces_earlier = replaces_earlier,
            .source = root_ / "recording"};
  }
  std::string complaint_about(const ResultsPlace& wanted) const {
    try {
      ResultsFolder results(wanted);
      results.begin();
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "none";
  }

  fs::path root_ =
      fs::path(testing::TempDir()) / ("samewhere_results_folder_" + std::to_string(getpid()));
};

TEST_F(ResultsFolderTest, IsMadeAtTheFirstFrameAndNotBefore) {
  ResultsFolder results(place("new/folder"));
  EXPECT_FALSE(fs::exists(root_ / "new"));
  EXPECT_FALSE(results.has_begun());
  results.begin();
  EXPECT_TRUE(results.has_begun());
  EXPECT_EQ(results.path(), root_ / "new/folder");
  EXPECT_TRUE(fs::is_empty(results.path()));
}

TEST_F(ResultsFolderTest, OfTwoRunsOfOneNameEachGetsItsOwn) {
  ResultsFolder first(place(""));
  ResultsFolder second(place(""));
  first.begin();
  second.begin();
  EXPECT_EQ(first.path(), root_ / "runs/walk");
  EXPECT_EQ(second.path(), root_ / "runs/walk-2");
}

TEST_F(ResultsFolderTest, OfAnEarlierRunIsOnlyTakenIfItMayBeReplaced) {
  EXPECT_THAT(complaint_about(place("earlier")),
              testing::AllOf(HasSubstr("earlier: holds the results of an earlier run"),
                             HasSubstr("--force")));
  { const ResultsFolder unused(place("earlier", true)); }
  EXPECT_TRUE(fs::exists(earlier("trajectory.tum"))) << "no frame came";
  EXPECT_EQ(complaint_about(place("earlier", true)), "none");
  for (const char* name : {"config.yaml", "trajectory.tum", "map.sw", "map.ply.partial-17-0"})
    EXPECT_FALSE(fs::exists(earlier(name))) << name;
  EXPECT_TRUE(fs::exists(earlier("notes.txt"))) << "of a user";
}

TEST_F(ResultsFolderTest, TheKnownMapStays) {
  ResultsPlace wanted = place("earlier", true);
  wanted.known_map = earlier("map.sw");
  EXPECT_EQ(complaint_about(wanted), "none");
  EXPECT_TRUE(fs::exists(earlier("map.sw")));
  EXPECT_FALSE(fs::exists(earlier("trajectory.tum")));
}

TEST_F(ResultsFolderTest, OneProgramAtATime) {
  std::optional<ResultsFolder> first(place("earlier", true));
  EXPECT_THAT(complaint_about(place("earlier", true)), HasSubstr("another program is writing"));
  first.reset();
  ResultsFolder late(place("new"));
  first.emplace(place("new"));
  first->begin();
  try {
    late.begin();
    ADD_FAILURE() << "two runs in one folder";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("new: another program is writing"));
  }
}

TEST_F(ResultsFolderTest, ARunThatEndedMeanwhileLosesNothing) {
  ResultsFolder late(place("new"));
  ResultsFolder(place("new")).begin();
  core::write_file(root_ / "new/config.yaml", "source: \"walk\"\n");
  EXPECT_THROW(late.begin(), core::InputError);
  EXPECT_TRUE(fs::exists(root_ / "new/config.yaml"));
}

TEST_F(ResultsFolderTest, OfTheRecordingOrOfAnotherIsRefused) {
  EXPECT_THAT(complaint_about(place("recording")), HasSubstr("is the recording itself"));
  core::write_file(root_ / "recording/frames.csv", "of a user");
  ResultsPlace of_another = place("recording", true);
  of_another.source = "elsewhere";
  EXPECT_THAT(complaint_about(of_another), HasSubstr("frames.csv: is there already and of no"));
  EXPECT_THAT(complaint_about(place("recording/frames.csv")), HasSubstr("is no folder"));
}

TEST_F(ResultsFolderTest, AMapThatIsBeingWrittenStays) {
  const scene::WriterLock lock(earlier("map.sw"), scene::WriterLock::File::kIsThere);
  EXPECT_THAT(complaint_about(place("earlier", true)),
              HasSubstr("map.sw: another program is writing to this map"));
  EXPECT_TRUE(fs::exists(earlier("trajectory.tum")));
}

}  // namespace
}  // namespace samewhere::report
