// The bags that the program writes and reads, against the reader and writer of ROS 1.

#include <cstdlib>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include "program.hpp"
#include <samewhere/input/test_folder.hpp>

namespace samewhere::test {
namespace {

TEST(Ros1Bags, HoldTheSameForPythonRosbag) {
  const input::TestFolder folder;
  // the system's Python, which finds Debian's packages
  const std::string command = "/usr/bin/python3 tests/formats/ros1_bags.py " +
                              quoted(SAMEWHERE_PROGRAM) + " " + quoted(folder.root());
  constexpr int kSkipped = 77;
  const int status = std::system(command.c_str());
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == kSkipped) GTEST_SKIP() << "python3-rosbag is not installed";
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace samewhere::test
