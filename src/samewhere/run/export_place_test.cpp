#include <filesystem>

#include <gmock/gmock.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/input/test_folder.hpp>
#include <samewhere/run/export_place.hpp>

namespace samewhere::run {
namespace {

using testing::HasSubstr;

class ExportPlace : public testing::Test {
 protected:
  std::filesystem::path path(const std::string& name) const { return folder_.root() / name; }

  template <class Check>
  static std::string complaint_of(const Check& check) {
    try {
      check();
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "none";
  }
  std::string complaint_about_folder(const std::string& name, bool replaces_earlier,
                                     const std::string& source = "twin:office-loop") const {
    return complaint_of([&] { check_export_folder(path(name), source, replaces_earlier); });
  }
  std::string complaint_about_file(const std::string& name, bool replaces_earlier) const {
    return complaint_of(
        [&] { check_export_file(path(name), path("run/map.sw"), replaces_earlier); });
  }

  input::TestFolder folder_;
};

TEST_F(ExportPlace, AnEarlierExportIsReplacedOnlyOnRequest) {
  EXPECT_EQ(complaint_about_folder("out", false), "none");
  begin_export_folder(path("out"), "first");
  folder_.write("out/images/old.png", "x");
  folder_.write("out/mine.txt", "x");
  EXPECT_THAT(complaint_about_folder("out", false),
              HasSubstr("expected another folder, or --force"));
  ASSERT_EQ(complaint_about_folder("out", true), "none");
  begin_export_folder(path("out"), "second");
  EXPECT_FALSE(std::filesystem::exists(path("out/images/old.png")));
  EXPECT_TRUE(std::filesystem::exists(path("out/mine.txt")));
  EXPECT_EQ(core::read_file(path("out") / kExportNote), "second");
}

TEST_F(ExportPlace, AFolderWithOtherFilesIsNeverReplaced) {
  folder_.write("recording/images/0.png", "x");
  for (const bool replaces_earlier : {false, true})
    EXPECT_THAT(complaint_about_folder("recording", replaces_earlier),
                HasSubstr("holds files that no export wrote"));
  EXPECT_THAT(complaint_about_folder("recording/images/0.png", true), HasSubstr("is no folder"));
}

TEST_F(ExportPlace, TheRecordingIsNotReplacedThoughAnExportWroteIt) {
  begin_export_folder(path("out"), "note");
  folder_.write("out/images/0.png", "x");
  EXPECT_THAT(complaint_about_folder("out", true, path("out/images").string()),
              HasSubstr("holds the recording itself"));
  EXPECT_EQ(complaint_about_folder("out", true, path("out-images").string()), "none");
}

TEST_F(ExportPlace, AFileIsReplacedOnlyOnRequestAndTheMapNever) {
  folder_.write("run/map.sw", "map");
  folder_.write("a.tum", "x");
  EXPECT_EQ(complaint_about_file("new/b.tum", false), "none");
  EXPECT_THAT(complaint_about_file("a.tum", false), HasSubstr("is there already"));
  EXPECT_EQ(complaint_about_file("a.tum", true), "none");
  EXPECT_THAT(complaint_about_file("run/map.sw", true), HasSubstr("is the map itself"));
  EXPECT_THAT(complaint_about_file("run", true), HasSubstr("is a folder; expected a file"));
}

}  // namespace
}  // namespace samewhere::run
