// Of a build with -DSAMEWHERE_DENSE=OFF alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/dense/octree_map.hpp>

namespace samewhere::dense {
namespace {

TEST(OctreeMapWithout, IsRefusedAndTheOptionNamed) {
  try {
    OctreeMap map{Config()};
    FAIL() << "there is a map";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("-DSAMEWHERE_DENSE=ON"));
  }
}

}  // namespace
}  // namespace samewhere::dense
