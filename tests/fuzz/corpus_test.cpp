#include <filesystem>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "readers.hpp"
#include <samewhere/core/file.hpp>

namespace samewhere::test {
namespace {

// Every file of a folder of tests/fuzz/corpus.
void for_each_of(const std::string& name, const std::function<void(const std::string&)>& read) {
  int count = 0;
  for (const auto& file : std::filesystem::directory_iterator("tests/fuzz/corpus/" + name)) {
    SCOPED_TRACE(file.path());
    EXPECT_NO_THROW(read(core::read_file(file.path())));
    ++count;
  }
  EXPECT_GT(count, 0);
}

TEST(FuzzCorpus, EveryBagIsReadOrRefused) { for_each_of("bag", read_as_bag); }

TEST(FuzzCorpus, EveryMessageIsReadOrRefused) { for_each_of("message", read_as_message); }

}  // namespace
}  // namespace samewhere::test
