#include <string>

#include <gtest/gtest.h>

#include <samewhere/core/checksum.hpp>

namespace samewhere::core {
namespace {

TEST(Checksum, IsFnv1aAsItsAuthorsPublishedIt) {
  EXPECT_EQ(checksum(""), 0xcbf29ce484222325ULL);
  EXPECT_EQ(checksum("a"), 0xaf63dc4c8601ec8cULL);
  EXPECT_EQ(checksum("foobar"), 0x85944171f73967e8ULL);
}

TEST(Checksum, TellsEveryChangedByteAndEveryCut) {
  const std::string bytes("\x00\xff\x10 some bytes", 14);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string changed = bytes;
    changed[i] = static_cast<char>(changed[i] ^ 1);
    EXPECT_NE(checksum(changed), checksum(bytes)) << i;
    EXPECT_NE(checksum(bytes.substr(0, i)), checksum(bytes)) << i;
  }
}

}  // namespace
}  // namespace samewhere::core
