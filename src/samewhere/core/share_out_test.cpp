#include <numeric>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include <samewhere/core/share_out.hpp>

namespace samewhere::core {
namespace {

TEST(ShareOut, AllThatIsDoneIsSeenAfterwards) {
  for (const int num_threads : {1, 2, 5}) {
    std::vector<int> squares(1000, -1);
    share_out(1000, num_threads, [&](int i) { squares[static_cast<std::size_t>(i)] = i * i; });
    for (int i = 0; i < 1000; ++i) {
      ASSERT_EQ(squares[static_cast<std::size_t>(i)], i * i) << num_threads;
    }
  }
}

TEST(ShareOut, AnErrorWaitsForTheOthers) {
  std::vector<int> times(40, 0);
  const auto work = [&](int i) {
    if (i == 1) throw std::runtime_error("no light");
    ++times[static_cast<std::size_t>(i)];
  };
  EXPECT_THROW(share_out(40, 4, work), std::runtime_error);
  EXPECT_EQ(std::accumulate(times.begin(), times.end(), 0), 30) << "three shares of four";
}

}  // namespace
}  // namespace samewhere::core
