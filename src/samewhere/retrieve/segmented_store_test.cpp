#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/retrieve/segmented_store.hpp>

namespace samewhere::retrieve {
namespace {

std::vector<float> vector_of(int number) { return {static_cast<float>(number), 0.0F, 1.0F}; }

// Frames 0, 1, ..., or every `stride`-th.
SegmentedStore store_of(int num_vectors, int stride = 1) {
  SegmentedStore store(100, 10);
  for (int i = 0; i < num_vectors; ++i) {
    store.append(core::FrameId(static_cast<std::uint64_t>(i * stride)), vector_of(i));
  }
  return store;
}

TEST(SegmentedStore, GivesBackWhatWasAppended) {
  const SegmentedStore store = store_of(250);
  EXPECT_EQ(store.num_vectors(), 250);
  EXPECT_EQ(store.vector_length(), 3);
  for (int i = 0; i < 250; ++i) {
    EXPECT_EQ(store.frame(i), core::FrameId(static_cast<std::uint64_t>(i)));
    EXPECT_TRUE(std::ranges::equal(store.vector(i), vector_of(i))) << i;
  }
}

TEST(SegmentedStore, NumberOfGroupsIsTheNumberOfVectorsOverAHundredRoundedUp) {
  EXPECT_EQ(store_of(0).num_groups(), 0);
  EXPECT_EQ(store_of(1).num_groups(), 1);
  EXPECT_EQ(store_of(100).num_groups(), 1);
  EXPECT_EQ(store_of(101).num_groups(), 2);
  EXPECT_EQ(store_of(1).queues_per_group(), 10);
}

TEST(SegmentedStore, QueuesAreTenConsecutiveVectorsAndCoverAllOnce) {
  for (const int num_vectors : {1, 9, 10, 11, 99, 100, 101, 257}) {
    const SegmentedStore store = store_of(num_vectors);
    int next = 0;
    for (int i = 0; i < store.num_groups() * store.queues_per_group(); ++i) {
      const PositionRange range = store.queue(i / 10, i % 10);
      EXPECT_EQ(range.begin, next);
      EXPECT_EQ(range.end, std::min(i * 10 + 10, num_vectors));
      next = range.end;
    }
    EXPECT_EQ(next, num_vectors);
  }
}

TEST(SegmentedStore, AGroupIsOneBlockThatNeverMoves) {
  SegmentedStore store = store_of(1);
  const float* first = store.vector(0).data();
  for (int i = 1; i < 500; ++i) {
    store.append(core::FrameId(static_cast<std::uint64_t>(i)), vector_of(i));
  }
  EXPECT_EQ(store.vector(0).data(), first);
  for (int i = 1; i < 100; ++i) EXPECT_EQ(store.vector(i).data() - first, i * 3);
}

TEST(SegmentedStore, TheWindowIsCountedInFramesNotInPositions) {
  const SegmentedStore store = store_of(20, 5);            // frames 0, 5, ..., 95
  EXPECT_EQ(store.num_older(core::FrameId(100), 50), 10);  // 45 is 55 older, 50 is 50 older: not
  EXPECT_EQ(store.num_older(core::FrameId(101), 50), 11);
  EXPECT_EQ(store.num_older(core::FrameId(10), 50), 0);
  EXPECT_EQ(store.num_older(core::FrameId(10), 0), 2);  // itself is not older
  EXPECT_EQ(store.num_older(core::FrameId(1000), 0), 20);
}

TEST(SegmentedStore, AnEarlierSessionIsOlderThanAnyWindow) {
  SegmentedStore store(100, 10);
  store.append(core::FrameId(5000, 1), vector_of(0));
  store.append(core::FrameId(3, 2), vector_of(1));
  EXPECT_EQ(store.num_older(core::FrameId(4, 2), 150), 1);
  EXPECT_EQ(store.num_older(core::FrameId(154, 2), 150), 2);
  EXPECT_EQ(store.num_older(core::FrameId(9000, 0), 150), 0);
}

TEST(SegmentedStore, RefusesFramesOutOfOrderAndVectorsOfAnotherLength) {
  SegmentedStore store = store_of(5);
  EXPECT_THROW(store.append(core::FrameId(4), vector_of(0)), core::ContractError);
  EXPECT_THROW(store.append(core::FrameId(), vector_of(0)), core::ContractError);
  EXPECT_THROW(store.append(core::FrameId(9), std::vector<float>(4)), core::ContractError);
  EXPECT_EQ(store.num_vectors(), 5);
  EXPECT_THROW(SegmentedStore(95, 10), core::ContractError);
  EXPECT_THROW(SegmentedStore(0, 10), core::ContractError);
  EXPECT_THROW(SegmentedStore(10, 0), core::ContractError);
}

}  // namespace
}  // namespace samewhere::retrieve
