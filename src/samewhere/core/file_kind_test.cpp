#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file_kind.hpp>

namespace samewhere::core {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class FileKind : public testing::Test {
 protected:
  FileKind() { fs::create_directories(folder_); }
  ~FileKind() override { fs::remove_all(folder_); }
  FileKind(const FileKind&) = delete;
  FileKind& operator=(const FileKind&) = delete;

  template <class Work>
  static std::string complaint(const Work& work) {
    try {
      work();
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  }

  fs::path folder_ =
      fs::path(testing::TempDir()) / ("samewhere_file_kind_" + std::to_string(getpid()));
};

TEST_F(FileKind, WhatIsThereAndWhatIsNot) {
  EXPECT_TRUE(is_there(folder_));
  EXPECT_TRUE(is_folder(folder_));
  EXPECT_FALSE(is_there(folder_ / "depth.txt"));
  EXPECT_FALSE(is_there(folder_ / "a/b/c"));
  EXPECT_FALSE(is_there(std::string("depth\0.txt", 10)));
  EXPECT_FALSE(is_there(folder_ / std::string(300, 'x')));
}

TEST_F(FileKind, ALinkThatLeadsNowhereIsNoMissingFile) {
  fs::create_symlink("/mnt/disk/depth.txt", folder_ / "depth.txt");
  EXPECT_THAT(complaint([&] { is_there(folder_ / "depth.txt"); }),
              HasSubstr("depth.txt: is a link to /mnt/disk/depth.txt, which is not there"));
  fs::create_symlink("/mnt/disk/mav0", folder_ / "mav0");
  EXPECT_THAT(complaint([&] { is_folder(folder_ / "mav0"); }), HasSubstr("mav0: is a link to"));
  EXPECT_THAT(complaint([&] { is_there(folder_ / "mav0/cam0/data.csv"); }),
              HasSubstr("mav0: is a link to /mnt/disk/mav0"));
  fs::create_symlink("loop", folder_ / "loop");
  EXPECT_THAT(complaint([&] { is_there(folder_ / "loop"); }),
              HasSubstr("loop: is a link to loop, which cannot be followed: Too many levels"));
}

TEST_F(FileKind, ALinkToSomethingIsThat) {
  fs::create_symlink(folder_, folder_ / "here");
  EXPECT_TRUE(is_folder(folder_ / "here"));
  EXPECT_FALSE(is_there(folder_ / "here/nothing"));
}

TEST_F(FileKind, FilesForALibraryAreFiles) {
  EXPECT_THAT(complaint([&] { require_file(folder_ / "walk.mp4"); }), HasSubstr("does not exist"));
  EXPECT_THAT(complaint([&] { require_file(folder_); }), HasSubstr("is a folder"));
  EXPECT_THAT(complaint([] { require_file("/dev/null"); }), HasSubstr("is a device"));
  ASSERT_EQ(mkfifo((folder_ / "walk.mp4").c_str(), 0600), 0);
  EXPECT_THAT(complaint([&] { require_file(folder_ / "walk.mp4"); }), HasSubstr("is a pipe"));
}

TEST_F(FileKind, WhatTheProcessWasGivenOpenIsToldByItsName) {
  for (const char* name : {"/dev/stdin", "/dev/stdout", "/dev/fd/63", "/proc/self/fd/0"})
    EXPECT_TRUE(is_open_descriptor(name)) << name;
  for (const char* name : {"/dev/null", "/dev/fd/", "/dev/fd/x", "stdin", "/dev/fd/1/x"})
    EXPECT_FALSE(is_open_descriptor(name)) << name;
}

}  // namespace
}  // namespace samewhere::core
