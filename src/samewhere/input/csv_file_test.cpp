#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/input/csv_file.hpp>
#include <samewhere/input/test_recording.hpp>

namespace samewhere::input {
namespace {

using testing::ElementsAre;

TEST_F(Open, CsvWordsAreCutAtCommasAndTrimmed) {
  folder_.write("a.csv", "#x,y\r\n\r\n 1 ,two words,\t3\r\n,\n");
  const auto lines = read_csv_lines(folder_.at("a.csv"));
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_THAT(lines[0].words, ElementsAre("1", "two words", "3"));
  EXPECT_THAT(lines[0].place, testing::EndsWith("a.csv, line 3"));
  EXPECT_THAT(lines[1].words, ElementsAre(""));
}

}  // namespace
}  // namespace samewhere::input
