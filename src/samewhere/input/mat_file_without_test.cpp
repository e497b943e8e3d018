#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/input/mat_file.hpp>
#include <samewhere/input/test_folder.hpp>

namespace samewhere::input {
namespace {

TEST(MatFileWithout, AMatlabFileIsRefusedWithTheReason) {
  EXPECT_THAT(complaint([] { read_mat_matrix("truth.mat"); }),
              testing::HasSubstr("truth.mat: built without MATLAB files"));
}

}  // namespace
}  // namespace samewhere::input
