#include <filesystem>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/folder_lock.hpp>

namespace samewhere::core {
namespace {

TEST(FolderLock, IsHeldByOneAtATimeAndLeavesNothing) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) /
                                       ("samewhere_folder_lock_" + std::to_string(getpid()));
  EXPECT_THROW(FolderLock{folder}, InputError) << "not there";
  std::filesystem::create_directory(folder);
  std::optional<FolderLock> first(folder);
  try {
    const FolderLock second(folder);
    ADD_FAILURE() << "two hold it";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("another program is writing into this folder"));
  }
  first.reset();
  EXPECT_NO_THROW(FolderLock{folder});
  EXPECT_TRUE(std::filesystem::is_empty(folder));
  std::filesystem::remove(folder);
}

}  // namespace
}  // namespace samewhere::core
