#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/text_file.hpp>

namespace samewhere::core {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;

class TextFile : public testing::Test {
 protected:
  ~TextFile() override { std::filesystem::remove(path_); }

  std::vector<TextLine> lines_of(const std::string& content) {
    write_file(path_, content);
    return read_text_lines(path_);
  }

  std::string complaint_about(const std::string& content) {
    try {
      lines_of(content);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  std::filesystem::path path_ = std::filesystem::path(testing::TempDir()) /
                                ("samewhere_text_file_" + std::to_string(getpid()));
};

TEST_F(TextFile, EveryEndOfALineAndAByteOrderMarkAreRead) {
  for (const char* text : {"1 a\n\n# no\n2 b\n", "1 a\r\n\r\n# no\r\n2 b\r\n", "1 a\r\r# no\r2 b",
                           "\xef\xbb\xbf"
                           "1 a\n\n# no\n2 b"}) {
    const std::vector<TextLine> lines = lines_of(text);
    ASSERT_EQ(lines.size(), 2U) << text;
    EXPECT_THAT(lines[0].words, ElementsAre("1", "a"));
    EXPECT_THAT(lines[1].words, ElementsAre("2", "b"));
    EXPECT_THAT(lines[1].place, EndsWith("line 4"));
  }
  EXPECT_TRUE(lines_of("\xef\xbb\xbf# only a remark\r\n").empty());
}

TEST_F(TextFile, ALineKeepsItsText) {
  EXPECT_EQ(lines_of("  1.5\tmy  pics/a.png \r\n").front().text, "1.5\tmy  pics/a.png");
}

TEST_F(TextFile, WideTextIsRefused) {
  using namespace std::string_literals;
  for (const std::string& text : {"\xff\xfe"
                                  "1\0\n\0"s,
                                  "\xfe\xff\0"
                                  "1\0\n"s,
                                  "1\0 \0a\0"s,
                                  "\0"
                                  "1\0 \0a"s}) {
    EXPECT_THAT(complaint_about(text), HasSubstr("UTF-16"));
  }
}

TEST_F(TextFile, APlusMayLeadANumber) {
  const TextLine line = lines_of("+1.5 -2 +3e+2 ++4 +-5 +\n").front();
  EXPECT_EQ(finite_number(line, 0), 1.5);
  EXPECT_EQ(finite_number(line, 1), -2.0);
  EXPECT_EQ(finite_number(line, 2), 300.0);
  for (const std::size_t column : {3U, 4U, 5U})
    EXPECT_THROW(finite_number(line, column), InputError) << column;
}

TEST(TextLines, NamesOfColumnsAreDropped) {
  std::vector<TextLine> lines = {{"", {"timestamp", "tx"}}, {"", {"1", "2"}}};
  drop_column_names(lines);
  ASSERT_EQ(lines.size(), 1U);
  for (const char* first : {"1", "+1", "nan", "inf", "-2", "0x"}) {
    lines = {{"", {first}}};
    drop_column_names(lines);
    EXPECT_EQ(lines.size(), 1U) << first;
  }
}

TEST(TextLines, TheMemoryOfThoseOfOneFileIsBounded) {
  LineMemory memory;
  const TextLine many_words{"list.txt, line 7", {}, std::string(8'000'000, ' ')};
  EXPECT_NO_THROW(memory.add(many_words));
  EXPECT_THROW(memory.add(many_words), InputError);
}

TEST(TextLines, WordsMayStandBetweenCommas) {
  EXPECT_THAT(words_between_commas("1, 2,3\t4"), ElementsAre("1", "2", "3", "4"));
}

}  // namespace
}  // namespace samewhere::core
