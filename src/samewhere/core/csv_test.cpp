#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/csv.hpp>

namespace samewhere::core {
namespace {

using testing::ElementsAre;

TEST(Csv, ARecordEndsAtALineBreakUnlessInQuotes) {
  EXPECT_THAT(csv_records("a,b\n1,2\n"), ElementsAre("a,b\n", "1,2\n"));
  EXPECT_THAT(csv_records("1,2\n3"), ElementsAre("1,2\n", "3"));
  EXPECT_THAT(csv_records(""), ElementsAre());
  const std::string field = csv_field("a \"name\",\nin lines");
  EXPECT_THAT(csv_records(field + ",1\n" + field), ElementsAre(field + ",1\n", field));
}

}  // namespace
}  // namespace samewhere::core
