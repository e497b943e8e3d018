#include <stdexcept>

#include <gtest/gtest.h>

#include <samewhere/core/ordered_workers.hpp>

namespace samewhere::core {
namespace {

TEST(OrderedWorkers, GiveAllItemsInOrderWhateverTheirNumber) {
  for (const int num_workers : {1, 2, 5}) {
    OrderedWorkers<int> workers(23, num_workers, [](int index) { return index * index; });
    for (int i = 0; i < 23; ++i) EXPECT_EQ(workers.next(), i * i) << num_workers;
    EXPECT_EQ(workers.next(), std::nullopt);
    EXPECT_EQ(workers.next(), std::nullopt);
  }
}

TEST(OrderedWorkers, AnErrorComesOutWithItsItem) {
  for (const int num_workers : {1, 2, 5}) {
    OrderedWorkers<int> workers(20, num_workers, [](int index) {
      if (index == 7) throw std::runtime_error("no light");
      return index;
    });
    for (int i = 0; i < 7; ++i) EXPECT_EQ(workers.next(), i);
    EXPECT_THROW(workers.next(), std::runtime_error);
    EXPECT_EQ(workers.next(), std::nullopt);
  }
}

TEST(OrderedWorkers, MayBeLeftAtAnyTimeAndDoNotRunFarAhead) {
  for (int num_taken = 0; num_taken < 6; ++num_taken) {
    constexpr int kNumWorkers = 3;
    std::vector<char> is_made(1000, 0);
    {
      OrderedWorkers<int> workers(1000, kNumWorkers, [&](int index) {
        is_made[static_cast<std::size_t>(index)] = 1;
        return index;
      });
      for (int i = 0; i < num_taken; ++i) EXPECT_EQ(workers.next(), i);
    }
    for (std::size_t i = 0; i < is_made.size(); ++i) {
      // one ready and one in the making each
      if (i >= static_cast<std::size_t>(num_taken + 3 * kNumWorkers)) {
        EXPECT_EQ(is_made[i], 0) << i;
      }
    }
  }
}

TEST(OrderedWorkers, NoItemsAreAnEnd) {
  OrderedWorkers<int> workers(0, 2, [](int index) { return index; });
  EXPECT_EQ(workers.next(), std::nullopt);
}

}  // namespace
}  // namespace samewhere::core
