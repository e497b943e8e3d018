#include <csignal>
#include <filesystem>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>

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

TEST_F(FileTest, APipeOrDeviceInPlaceOfAFileIsRefusedAtOnce) {
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(error_of([&] { read_file(folder_ / "pipe"); }),
              HasSubstr("pipe: is a pipe, expected a file"));
  EXPECT_THAT(error_of([] { read_file("/dev/zero"); }),
              HasSubstr("/dev/zero: is a device, expected a file"));
  fs::create_symlink("/dev/zero", folder_ / "endless");
  EXPECT_THAT(error_of([&] { read_file(folder_ / "endless"); }), HasSubstr("is a device"));
}

TEST_F(FileTest, APipeThatTheProcessWasGivenOpenIsRead) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  ASSERT_EQ(write(ends[1], "words", 5), 5);
  close(ends[1]);
  EXPECT_EQ(read_file("/dev/fd/" + std::to_string(ends[0])), "words");
  close(ends[0]);
}

TEST_F(FileTest, AFileLargerThanItsKindIsRefusedBeforeMemoryIsTaken) {
  write_file(folder_ / "sparse.txt", "");
  fs::resize_file(folder_ / "sparse.txt", 1'000'000'000'000);
  EXPECT_THAT(error_of([&] { read_file(folder_ / "sparse.txt"); }),
              HasSubstr("sparse.txt: is larger than 128 MB, expected a text file"));
  write_file(folder_ / "long", std::string(2 * kMegabyte, 'x'));
  EXPECT_THAT(error_of([&] { read_file(folder_ / "long", kSettingsLimit); }),
              HasSubstr("is larger than 1 MB, expected a file of settings"));
  // the system tells no size of this one
  EXPECT_THAT(error_of([&] {
                read_file("/proc/self/status", {100, "a note"});
              }),
              HasSubstr("expected a note"));
}

TEST_F(FileTest, ALinkThatLeadsNowhereIsNamedWithWhereItLeads) {
  fs::create_symlink("/mnt/disk/camera.txt", folder_ / "camera.txt");
  EXPECT_THAT(error_of([&] { read_file(folder_ / "camera.txt"); }),
              HasSubstr("camera.txt: is a link to /mnt/disk/camera.txt, which is not there"));
}

TEST_F(FileTest, AnErrorWhileWritingLeavesTheOldFile) {
  write_file(folder_ / "map", "old");
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto ignored = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{1000, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string error = error_of([&] { write_file(folder_ / "map", std::string(5000, 'x')); });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, ignored);
  EXPECT_THAT(error, AllOf(HasSubstr("map: cannot be written"), HasSubstr("File too large")));
  EXPECT_EQ(read_file(folder_ / "map"), "old");
  EXPECT_EQ(num_entries(), 1) << "no temporary file is left";
}

TEST_F(FileTest, ALinkIsReplacedAndWhatItLeadsToStays) {
  write_file(folder_ / "mine", "old");
  for (const auto& write : {&write_file, &replace_file}) {
    fs::remove(folder_ / "link");
    fs::create_symlink(folder_ / "mine", folder_ / "link");
    write(folder_ / "link", "new");
    EXPECT_FALSE(fs::is_symlink(folder_ / "link"));
    EXPECT_EQ(read_file(folder_ / "link"), "new");
    EXPECT_EQ(read_file(folder_ / "mine"), "old");
  }
  EXPECT_EQ(num_entries(), 2);
}

TEST_F(FileTest, ADraftHasNoNameUntilItIsWholeAndLeavesNothing) {
  write_file(folder_ / "graph", "old");
  {
    const Draft draft(folder_ / "graph", "new");
    EXPECT_EQ(read_file(folder_ / "graph"), "old");
  }
  EXPECT_EQ(num_entries(), 1);
  EXPECT_EQ(error_of_new_file(folder_), 0);
  EXPECT_EQ(num_entries(), 1);
}

TEST_F(FileTest, ANewFileTakesNoName) {
  EXPECT_TRUE(write_new_file(folder_ / "map", "mine"));
  EXPECT_FALSE(write_new_file(folder_ / "map", "other"));
  EXPECT_EQ(read_file(folder_ / "map"), "mine");
  fs::create_symlink("nowhere", folder_ / "link");
  EXPECT_FALSE(write_new_file(folder_ / "link", "other"));
  EXPECT_EQ(num_entries(), 2) << "no temporary file is left";
}

TEST_F(FileTest, FilesThatGoTogetherChangeTogetherOrNotAtAll) {
  write_file(folder_ / "a", "old");
  {
    FilesTogether files;
    files.add(folder_ / "a", "new");
    EXPECT_THROW(files.add(folder_ / "nowhere" / "b", "new"), InputError);
  }
  EXPECT_EQ(read_file(folder_ / "a"), "old");
  FilesTogether files;
  files.add(folder_ / "a", "new");
  files.add(folder_ / "b", "new");
  EXPECT_EQ(read_file(folder_ / "a"), "old");
  files.publish();
  EXPECT_EQ(read_file(folder_ / "a") + read_file(folder_ / "b"), "newnew");
  EXPECT_EQ(num_entries(), 2) << "no temporary file is left";
}

TEST_F(FileTest, TheTemporaryNameIsOneThatNoFileHas) {
  write_file(folder_ / "mine", "old");
  const std::string partial = "graph.partial-" + std::to_string(getpid()) + "-";
  fs::create_symlink(folder_ / "mine", folder_ / (partial + "0"));
  fs::create_symlink(folder_ / "mine", folder_ / "graph.partial");
  write_file(folder_ / "graph", "new");
  EXPECT_EQ(read_file(folder_ / "mine"), "old");
  EXPECT_EQ(read_file(folder_ / "graph"), "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / (partial + "0"))) << "of another program";
}

TEST_F(FileTest, WhatKilledProgramsLeftOfAFileIsRemoved) {
  for (const char* name : {"map.partial-17-0", "map.partial-4711-12", "map.partial-mine", "map"})
    write_file(folder_ / name, "x");
  remove_partial_files(folder_ / "map");
  EXPECT_EQ(num_entries(), 2);
  EXPECT_TRUE(fs::exists(folder_ / "map.partial-mine"));
}

TEST_F(FileTest, APipeIsWrittenToAndStays) {
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(error_of([&] { write_file(folder_ / "pipe", "bytes"); }),
              HasSubstr("pipe: cannot be written: no program reads this pipe"));
  const int reader = open((folder_ / "pipe").c_str(), O_RDONLY | O_NONBLOCK);
  write_file(folder_ / "pipe", "bytes");
  char read_back[8] = {};
  EXPECT_EQ(::read(reader, read_back, sizeof read_back), 5);
  EXPECT_STREQ(read_back, "bytes");
  close(reader);
  EXPECT_TRUE(fs::is_fifo(folder_ / "pipe"));
  replace_file(folder_ / "pipe", "result");
  EXPECT_EQ(read_file(folder_ / "pipe"), "result") << "of a folder of its own";
}

TEST_F(FileTest, NoDeviceIsReplaced) {
  EXPECT_THAT(error_of([] { replace_file("/dev/null", "x"); }), HasSubstr("is a device"));
  write_file("/dev/null", "x");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
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
  write_file(folder_ / "mine", "old");
  fs::create_symlink(folder_ / "mine", folder_ / "a" / "b" / ".writable");
  EXPECT_NO_THROW(make_writable_folder(folder_ / "a" / "b")) << "there already";
  EXPECT_TRUE(fs::is_symlink(folder_ / "a" / "b" / ".writable")) << "that of a user";
  EXPECT_EQ(read_file(folder_ / "mine"), "old");
}

TEST_F(FileTest, ANewFolderIsMadeOnce) {
  EXPECT_TRUE(make_new_folder(folder_ / "runs" / "walk"));
  EXPECT_FALSE(make_new_folder(folder_ / "runs" / "walk"));
  fs::create_symlink("nowhere", folder_ / "runs" / "link");
  EXPECT_FALSE(make_new_folder(folder_ / "runs" / "link"));
  write_file(folder_ / "file", "");
  EXPECT_THAT(error_of([&] { make_new_folder(folder_ / "file" / "walk"); }),
              HasSubstr("cannot be made"));
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
