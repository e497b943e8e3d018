#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <samewhere/core/nearest_word.hpp>

namespace samewhere::core {
namespace {

TEST(EditDistance, CountsLettersInsertedDeletedReplacedAndSwapped) {
  EXPECT_EQ(edit_distance("", ""), 0);
  EXPECT_EQ(edit_distance("", "run"), 3);
  EXPECT_EQ(edit_distance("run", "run"), 0);
  EXPECT_EQ(edit_distance("runn", "run"), 1);
  EXPECT_EQ(edit_distance("rn", "run"), 1);
  EXPECT_EQ(edit_distance("ran", "run"), 1);
  EXPECT_EQ(edit_distance("rnu", "run"), 1);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
}

TEST(NearestWord, IsTheOneThatWasProbablyMeant) {
  const std::vector<std::string> commands = {"run", "loops", "eval", "ledger", "map", "optimize"};
  EXPECT_EQ(nearest_word("rnu", commands), "run");
  EXPECT_EQ(nearest_word("lops", commands), "loops");
  EXPECT_EQ(nearest_word("optimise", commands), "optimize");
  EXPECT_EQ(nearest_word("maps", commands), "map");
}

TEST(NearestWord, IsNothingIfNoneIsNear) {
  const std::vector<std::string> commands = {"run", "loops", "map"};
  EXPECT_EQ(nearest_word("calibrate", commands), std::nullopt);
  EXPECT_EQ(nearest_word("me", commands), std::nullopt) << "two letters of three are no hint";
  EXPECT_EQ(nearest_word("", commands), std::nullopt);
  EXPECT_EQ(nearest_word(std::string(1'000'000, 'x'), commands), std::nullopt);
}

}  // namespace
}  // namespace samewhere::core
