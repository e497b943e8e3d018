#include <filesystem>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/file_reader.hpp>

namespace samewhere::core {
namespace {

std::filesystem::path empty_folder_of_streams() {
  const std::filesystem::path folder =
      std::filesystem::path(::testing::TempDir()) / "samewhere_file_reader_test";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

TEST(FileReader, ReadsPartsAndRefusesWhatLiesBehindTheEnd) {
  const std::filesystem::path folder = empty_folder_of_streams();
  write_file(folder / "a", "0123456789");
  const FileReader file(folder / "a");
  EXPECT_EQ(file.size(), 10U);
  EXPECT_EQ(file.read(3, 4), "3456");
  EXPECT_EQ(file.read(10, 0), "");
  EXPECT_THROW(file.read(8, 3), InputError);
  EXPECT_THROW(file.read(11, 0), InputError);
  EXPECT_THROW(file.read(1, ~std::uint64_t{0}), InputError);
  EXPECT_THROW(FileReader{folder}, InputError);
}

TEST(FileStream, GetsItsNameWhenItIsComplete) {
  const std::filesystem::path folder = empty_folder_of_streams();
  const std::filesystem::path path = folder / "a";
  write_file(path, "before");
  {
    FileStream given_up(path);
    given_up.write("half");
  }
  EXPECT_EQ(read_file(path), "before");
  FileStream file(path);
  file.write("00 and the rest");
  file.overwrite(0, "42");
  EXPECT_EQ(file.position(), 15U);
  EXPECT_EQ(read_file(path), "before");
  file.publish();
  EXPECT_EQ(read_file(path), "42 and the rest");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
}

}  // namespace
}  // namespace samewhere::core
