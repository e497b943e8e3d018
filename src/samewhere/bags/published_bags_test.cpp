#include <cstdlib>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/bags/bag.hpp>
#include <samewhere/bags/test_bag.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>

// Files that the projects of MCAP and ROS 2 publish to test readers with, where SAMEWHERE_DATA says
// they lie.
namespace samewhere::bags {
namespace {

using std::filesystem::path;

class PublishedBags : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* const folder = std::getenv("SAMEWHERE_DATA");
    if (folder == nullptr) GTEST_SKIP() << "SAMEWHERE_DATA is not set";
    folder_ = path(folder) / "bags";
  }

  path folder_;
};

// The published files are there as checksums beside descriptions: a script makes them, and stops at
// a checksum that is another one.
TEST_F(PublishedBags, ConformanceFilesOfMcapAreReadAsTheyAreDescribed) {
  const BagFolder made;
  const std::string command = "python3 tests/formats/mcap_conformance.py " +
                              (folder_ / "mcap_conformance").string() + " " + made.at("").string();
  ASSERT_EQ(std::system(command.c_str()), 0);
  int num_files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(made.at(""))) {
    if (entry.path().extension() != ".mcap") continue;
    SCOPED_TRACE(entry.path().filename().string());
    const auto bag = open_bag(entry.path());
    std::string found;
    for (const ReadMessage& message : all_messages(*bag)) {
      found += std::to_string(message.log_time_ns);
      for (const char byte : message.bytes)
        found += " " + std::to_string(static_cast<unsigned char>(byte));
      found += "\n";
    }
    EXPECT_EQ(found, core::read_file(path(entry.path()).replace_extension(".txt")));
    EXPECT_EQ(bag->info().damage, "");
    ++num_files;
  }
  EXPECT_EQ(num_files, 160);
}

TEST_F(PublishedBags, FilesOfRosbag2HoldTheSameInBothFormats) {
  for (const char* name : {"cdr_test_0", "talker", "wbag_0", "wbag_1"}) {
    SCOPED_TRACE(name);
    const auto mcap = open_bag(folder_ / (std::string(name) + ".mcap"));
    const auto sqlite = open_bag(folder_ / (std::string(name) + ".db3"));
    const auto messages = all_messages(*mcap);
    EXPECT_FALSE(messages.empty());
    EXPECT_TRUE(messages == all_messages(*sqlite));
    EXPECT_EQ(mcap->topics().size(), sqlite->topics().size());
  }
}

TEST_F(PublishedBags, TextsOfTheTalkerAreRead) {
  const auto bag = open_bag(folder_ / "talker.mcap");
  int num_texts = 0;
  for (const ReadMessage& message : all_messages(*bag)) {
    if (message.topic != "/topic") continue;
    ++num_texts;
    EXPECT_TRUE(messages::read_message<messages::String>(message.bytes, messages::Layout::kCdr)
                    .data.starts_with("Hello, world!"));
  }
  EXPECT_EQ(num_texts, 10);
}

// None of them stops the program; what is wrong is one line.
TEST_F(PublishedBags, EveryFileIsReadOrRefusedInOneLine) {
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".mcap" && extension != ".db3") continue;
    try {
      all_messages(*open_bag(entry.path()));
    } catch (const core::InputError& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr(entry.path().string()));
    }
  }
}

}  // namespace
}  // namespace samewhere::bags
