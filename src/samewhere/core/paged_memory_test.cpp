#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/paged_memory.hpp>
#include <samewhere/core/test_temporary_folder.hpp>

namespace samewhere::core {
namespace {

constexpr std::size_t kMebibyte = std::size_t{1} << 20U;

// Of mapped files that are in the memory of this process, kibibytes (proc(5)).
long mapped_kib() {
  std::ifstream status("/proc/self/status");
  long sum = 0;
  std::string name;
  for (long value = 0; status >> name;) {
    if ((name == "RssFile:" || name == "RssShmem:") && status >> value) sum += value;
    status.ignore(1000, '\n');
  }
  return sum;
}

TEST(PagedMemory, BlocksAreApartAndKeepWhatIsWritten) {
  PagedMemory memory;
  const auto a = memory.allocate(1000);
  const auto b = memory.allocate(40 * kMebibyte);  // larger than a file
  const auto c = memory.allocate(5000);
  ASSERT_TRUE(a && b && c);
  EXPECT_EQ(a->bytes().size(), 1000U);
  std::fill(a->bytes().begin(), a->bytes().end(), std::byte{1});
  std::fill(b->bytes().begin(), b->bytes().end(), std::byte{2});
  std::fill(c->bytes().begin(), c->bytes().end(), std::byte{3});
  EXPECT_EQ(std::count(a->bytes().begin(), a->bytes().end(), std::byte{1}), 1000);
  EXPECT_EQ(b->bytes().front(), std::byte{2});
  EXPECT_EQ(b->bytes().back(), std::byte{2});
  EXPECT_EQ(std::count(c->bytes().begin(), c->bytes().end(), std::byte{3}), 5000);
}

TEST(PagedMemory, ABlockLeavesMemoryAndComesBackAsItWas) {
  PagedMemory memory;
  const auto block = memory.allocate(8 * kMebibyte);
  ASSERT_TRUE(block);
  for (std::size_t i = 0; i < block->bytes().size(); ++i)
    block->bytes()[i] = static_cast<std::byte>(i % 251);
  const long before_kib = mapped_kib();
  block->leave_memory();
  EXPECT_LT(mapped_kib(), before_kib - 7 * 1024);
  std::size_t num_wrong = 0;
  for (std::size_t i = 0; i < block->bytes().size(); ++i)
    num_wrong += block->bytes()[i] != static_cast<std::byte>(i % 251) ? 1 : 0;
  EXPECT_EQ(num_wrong, 0U);
}

TEST(PagedMemory, ABlockOutlivesTheMemoryItCameFrom) {
  std::shared_ptr<const PagedBlock> block;
  {
    PagedMemory memory;
    block = memory.allocate(100);
    ASSERT_TRUE(block);
    block->bytes()[99] = std::byte{7};
  }
  block->leave_memory();
  EXPECT_EQ(block->bytes()[99], std::byte{7});
}

TEST(PagedMemory, ABlockThatGoesLeavesAHoleInItsFile) {
  PagedMemory memory;
  auto block = memory.allocate(kMebibyte);
  const auto neighbour = memory.allocate(kMebibyte);  // keeps the file mapped
  ASSERT_TRUE(block && neighbour);
  std::fill(block->bytes().begin(), block->bytes().end(), std::byte{1});
  std::fill(neighbour->bytes().begin(), neighbour->bytes().end(), std::byte{2});
  const std::span<const std::byte> place = block->bytes();
  block.reset();
  EXPECT_EQ(std::count(place.begin(), place.end(), std::byte{0}), std::ssize(place));
  EXPECT_EQ(neighbour->bytes().front(), std::byte{2});
  EXPECT_EQ(neighbour->bytes().back(), std::byte{2});
}

TEST(PagedMemory, WithoutAFolderThereIsNone) {
  const TemporaryFolder folder("/nonexistent");
  PagedMemory memory;
  EXPECT_EQ(memory.allocate(100), nullptr);
}

TEST(PagedMemory, NoBytesAreABrokenPromise) {
  PagedMemory memory;
  EXPECT_THROW(memory.allocate(0), ContractError);
}

}  // namespace
}  // namespace samewhere::core
