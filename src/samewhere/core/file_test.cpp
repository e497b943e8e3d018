#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/stage_thread.hpp>

namespace samewhere::core {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

class FileTest : public testing::Test {
 protected:
  FileTest() {
    const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) /
              (std::string("samewhere_file_") + test.name() + "_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  ~FileTest() override { fs::remove_all(folder_); }
  FileTest(const FileTest&) = delete;
  FileTest& operator=(const FileTest&) = delete;

  int num_entries() const {
    return static_cast<int>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
};

template <class Function>
std::string error_of(Function function) {
  try {
    function();
  } catch (const InputError& error) {
    return error.what();
  }
  return "(no InputError)";
}

TEST_F(FileTest, WhatIsWrittenIsReadBackByteForByte) {
  std::string bytes;
  for (int i = 0; i < 300'000; ++i) bytes += static_cast<char>(i * 7 % 256);
  write_file(folder_ / "bytes", bytes);
  EXPECT_EQ(read_file(folder_ / "bytes"), bytes);
  write_file(folder_ / "bytes", "");
  EXPECT_EQ(read_file(folder_ / "bytes"), "");
  EXPECT_EQ(num_entries(), 1) << "no temporary file is left";
}

TEST_F(FileTest, AFileWhoseSizeTheSystemDoesNotTellIsReadWhole) {
  EXPECT_THAT(read_file("/proc/self/status"), HasSubstr("Pid:"));
}

TEST_F(FileTest, AMissingFileIsNamed) {
  EXPECT_THAT(error_of([&] { read_file(folder_ / "nowhere.txt"); }),
              AllOf(HasSubstr("nowhere.txt"), HasSubstr("No such file")));
}

TEST_F(FileTest, AFolderIsNotAFile) {
  EXPECT_THAT(error_of([&] { read_file(folder_); }), HasSubstr("is a folder, expected a file"));
}

TEST_F(FileTest, AFileThatCannotBeReadToItsEndIsAnInputError) {
  EXPECT_THAT(error_of([] { read_file("/proc/self/mem"); }),
              AllOf(HasSubstr("/proc/self/mem"), HasSubstr("cannot be read")));
}

TEST_F(FileTest, ANameThatIsTooLongIsAnInputError) {
  EXPECT_THAT(error_of([&] { read_file(folder_ / std::string(300, 'x')); }),
              HasSubstr("cannot be read"));
}

TEST_F(FileTest, AFullDiskIsReportedAndTheOldFileStays) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  write_file(folder_ / "map", "old");
  // the temporary file that write_file opens leads to a device that is always full
  fs::create_symlink("/dev/full", folder_ / "map.partial");
  EXPECT_THAT(error_of([&] { write_file(folder_ / "map", "new"); }),
              AllOf(HasSubstr("map"), HasSubstr("No space left")));
  EXPECT_EQ(read_file(folder_ / "map"), "old");
  EXPECT_EQ(num_entries(), 1) << "no temporary file is left";
}

TEST_F(FileTest, OfALinkThatWhichItLeadsToIsWritten) {
  write_file(folder_ / "kept", "old");
  fs::create_symlink(folder_ / "kept", folder_ / "link");
  write_file(folder_ / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(read_file(folder_ / "kept"), "new");
  EXPECT_EQ(num_entries(), 2);
  fs::create_symlink("not-yet", folder_ / "ahead");
  write_file(folder_ / "ahead", "made");
  EXPECT_TRUE(fs::is_symlink(folder_ / "ahead"));
  EXPECT_EQ(read_file(folder_ / "not-yet"), "made");
}

TEST_F(FileTest, APipeIsWrittenToAndStays) {
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  std::string read;
  WorkerThread reader([&] { read = read_file(folder_ / "pipe"); });
  write_file(folder_ / "pipe", "bytes");
  reader.join();
  EXPECT_EQ(read, "bytes");
  EXPECT_TRUE(fs::is_fifo(folder_ / "pipe"));
}

TEST_F(FileTest, AFolderInTheWayOfAFileIsReported) {
  fs::create_directory(folder_ / "taken");
  EXPECT_THAT(error_of([&] { write_file(folder_ / "taken", "x"); }),
              AllOf(HasSubstr("taken"), HasSubstr("cannot be written")));
  EXPECT_EQ(num_entries(), 1) << "no temporary file is left";
}

TEST_F(FileTest, FoldersAreMadeAllTheWayAndLeftEmpty) {
  make_writable_folder(folder_ / "a" / "b");
  EXPECT_TRUE(fs::is_empty(folder_ / "a" / "b"));
  EXPECT_NO_THROW(make_writable_folder(folder_ / "a" / "b")) << "there already";
}

TEST_F(FileTest, AFolderThatCannotBeMadeOrWrittenIsNamed) {
  write_file(folder_ / "file", "");
  EXPECT_THAT(error_of([&] { make_writable_folder(folder_ / "file" / "runs"); }),
              HasSubstr("file/runs: cannot be made"));
  EXPECT_THAT(error_of([&] { make_writable_folder(folder_ / "file"); }), HasSubstr("file"));
  // not even root may make files here
  EXPECT_THAT(error_of([] { make_writable_folder("/proc/self"); }), HasSubstr("/proc/self"));
}

}  // namespace
}  // namespace samewhere::core
