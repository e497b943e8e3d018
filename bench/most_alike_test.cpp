#include "most_alike.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace samewhere::bench {
namespace {

TEST(MostAlike, TheMostAlikeComeFirst) {
  const std::vector<std::vector<float>> vectors = {{1, 0}, {0, 1}, {0.8F, 0.6F}, {1, 0}};
  EXPECT_THAT(most_alike(vectors, 0, {1, 2, 3}, 2), testing::ElementsAre(3, 2));
  EXPECT_THAT(most_alike(vectors, 0, {1}, 50), testing::ElementsAre(1));
}

}  // namespace
}  // namespace samewhere::bench
