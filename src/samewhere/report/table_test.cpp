#include <gtest/gtest.h>

#include <samewhere/report/table.hpp>

namespace samewhere::report {
namespace {

TEST(Table, ColumnsLineUpAndCommasAreQuoted) {
  const Table table{.header = {"name", "n"}, .rows = {{"a, b", "12"}, {"c", "3"}}};
  EXPECT_EQ(as_text(table), "name   n\na, b  12\nc      3\n");
  EXPECT_EQ(as_csv(table), "name,n\n\"a, b\",12\nc,3\n");
}

}  // namespace
}  // namespace samewhere::report
