#include <gtest/gtest.h>

#include <samewhere/core/kitti_file.hpp>

namespace samewhere::core {
namespace {

TEST(KittiFile, ALineIsTheUpperThreeRowsOfThePose) {
  // a third of a turn about the diagonal: the camera's x axis is the world's y axis, y is z, z is x
  const Eigen::Quaterniond turn(0.5, 0.5, 0.5, 0.5);
  EXPECT_EQ(kitti_text({{12.5, {turn, {1.0, 2.0, -3.5}}}}),
            "0.000000000 0.000000000 1.000000000 1.000000000 "
            "1.000000000 0.000000000 0.000000000 2.000000000 "
            "0.000000000 1.000000000 0.000000000 -3.500000000\n");
  EXPECT_EQ(kitti_text({}), "");
}

}  // namespace
}  // namespace samewhere::core
