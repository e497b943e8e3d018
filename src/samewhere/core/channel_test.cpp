#include <chrono>
#include <memory>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include <samewhere/core/channel.hpp>
#include <samewhere/core/stage_thread.hpp>

namespace samewhere::core {
namespace {

TEST(Channel, MessagesArriveInTheOrderInWhichTheyWereSent) {
  constexpr int kNumMessages = 10'000;
  Channel<int> channel(3);
  WorkerThread writer([&] {
    for (int i = 0; i < kNumMessages; ++i) channel.send(i);
    channel.close();
  });
  for (int i = 0; i < kNumMessages; ++i) ASSERT_EQ(channel.receive(), i);
  EXPECT_EQ(channel.receive(), std::nullopt);
  writer.join();
}

TEST(Channel, WhatIsLeftArrivesAfterItIsClosedAndThenNothing) {
  Channel<int> channel(2);
  EXPECT_TRUE(channel.send(1));
  EXPECT_TRUE(channel.send(2));
  channel.close();
  EXPECT_FALSE(channel.send(3)) << "a closed channel takes no message";
  EXPECT_EQ(channel.receive(), 1);
  EXPECT_EQ(channel.receive(), 2);
  EXPECT_EQ(channel.receive(), std::nullopt);
  EXPECT_EQ(channel.receive(), std::nullopt);
}

TEST(Channel, TheNewestTakesThePlaceOfWhatWaits) {
  Channel<int> channel(2);
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(channel.send_newest(i)) << "the writer never waits";
  EXPECT_EQ(channel.receive(), 4);
  EXPECT_TRUE(channel.send_newest(5));
  channel.close();
  EXPECT_FALSE(channel.send_newest(6));
  EXPECT_EQ(channel.receive(), 5);
  EXPECT_EQ(channel.receive(), std::nullopt);
}

TEST(Channel, AWaitingWriterIsToldAtOnceThatTheChannelIsClosed) {
  Channel<int> channel(1);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_TRUE(channel.is_open_for(0.02));
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(20));
  Channel<bool> is_told(1);
  WorkerThread writer([&] { is_told.send(channel.is_open_for(3600.0)); });
  EXPECT_TRUE(channel.send(1)) << "a waiting writer blocks no other";
  channel.close();
  EXPECT_EQ(is_told.receive(), false);
}

TEST(Channel, AWriterNeverRunsAheadOfItsReaderByMoreThanTheCapacity) {
  constexpr int kCapacity = 4;
  Channel<int> channel(kCapacity);
  Channel<int> progress(1000);  // how far the writer has come, in its own order
  WorkerThread writer([&] {
    for (int i = 0; i < 100 && channel.send(i); ++i) progress.send(i);
    progress.close();
  });
  int num_received = 0;
  int num_sent = 0;
  while (num_sent < 100) {
    num_sent = *progress.receive() + 1;
    ASSERT_LE(num_sent, num_received + kCapacity);
    if (num_sent == num_received + kCapacity || num_sent == 100) {
      ASSERT_EQ(channel.receive(), num_received);
      ++num_received;
    }
  }
  writer.join();
}

TEST(Channel, ClosingWakesAWriterThatWaits) {
  Channel<int> channel(1);
  bool was_sent = true;
  channel.send(1);
  WorkerThread writer([&] { was_sent = channel.send(2); });
  channel.close();
  writer.join();
  EXPECT_FALSE(was_sent);
}

TEST(Channel, ClosingWakesAReaderThatWaits) {
  Channel<int> channel(1);
  std::optional<int> received = 7;
  WorkerThread reader([&] { received = channel.receive(); });
  channel.close();
  reader.join();
  EXPECT_EQ(received, std::nullopt);
}

TEST(Channel, MessagesAreMovedNotCopied) {
  Channel<std::unique_ptr<int>> channel(1);
  channel.send(std::make_unique<int>(5));
  EXPECT_EQ(**channel.receive(), 5);
}

TEST(Channel, ACapacityOfNothingIsAMistake) { EXPECT_THROW(Channel<int>(0), ContractError); }

TEST(WorkerThread, AnExceptionComesOutOfJoinOnce) {
  WorkerThread worker([] { throw InputError("no such frame"); });
  EXPECT_THROW(worker.join(), InputError);
  EXPECT_NO_THROW(worker.join());
}

TEST(WorkerThread, DestructionWithoutJoinSwallowsTheException) {
  EXPECT_NO_THROW(WorkerThread([] { throw InputError("not asked for"); }));
}

TEST(SourceThread, SendsWhatThereIsAndClosesTheChannel) {
  Channel<int> numbers(2);
  int next = 0;
  SourceThread<int> source(numbers,
                           [&] { return next < 50 ? std::optional(next++) : std::nullopt; });
  for (int i = 0; i < 50; ++i) ASSERT_EQ(numbers.receive(), i);
  EXPECT_EQ(numbers.receive(), std::nullopt);
  source.join();
}

TEST(SourceThread, AnExceptionClosesTheChannelAndComesOutOfJoin) {
  Channel<int> numbers(2);
  SourceThread<int> source(numbers, []() -> std::optional<int> { throw InputError("cut short"); });
  EXPECT_EQ(numbers.receive(), std::nullopt);
  EXPECT_THROW(source.join(), InputError);
}

TEST(SourceThread, DestructionDoesNotWaitForAReaderThatHasLeft) {
  Channel<int> numbers(1);
  {
    const SourceThread<int> source(numbers, [] { return std::optional(1); });
  }
  EXPECT_FALSE(numbers.send(1));
}

TEST(StageThread, AChainOfStagesAnswersEveryMessageInOrderAndEndsWhenTheFirstChannelIsClosed) {
  Channel<int> numbers(2);
  Channel<int> squares(2);
  Channel<std::string> words(2);
  StageThread<int, int> square(numbers, squares, [](int x) { return x * x; });
  StageThread<int, std::string> print(squares, words, [](int x) { return std::to_string(x); });
  WorkerThread writer([&] {
    for (int i = 0; i < 50; ++i) numbers.send(i);
    numbers.close();
  });
  int num_words = 0;
  while (const auto word = words.receive()) {
    EXPECT_EQ(*word, std::to_string(num_words * num_words));
    ++num_words;
  }
  EXPECT_EQ(num_words, 50);
  writer.join();
  square.join();
  print.join();
}

TEST(StageThread, AnExceptionEndsTheNeighboursAndComesOutOfJoin) {
  Channel<int> in(1);
  Channel<int> out(1);
  StageThread<int, int> stage(in, out, [](int x) {
    if (x == 3) throw InputError("frame 3 is cut short");
    return x;
  });
  WorkerThread writer([&] {
    for (int i = 0; in.send(i);) ++i;  // ends only because the failing stage closes `in`
  });
  std::vector<int> received;
  while (const auto x = out.receive()) received.push_back(*x);
  EXPECT_EQ(received, (std::vector<int>{0, 1, 2}));
  writer.join();
  EXPECT_THROW(stage.join(), InputError);
}

TEST(Channel, OldestOfWhatIsAlikeMakesRoomForTheNewest) {
  Channel<int> channel(5);
  const auto is_even = [](int x) { return x % 2 == 0; };
  for (const int x : {1, 2, 4}) EXPECT_EQ(channel.send_limited(x, 2, is_even), 0U);
  EXPECT_EQ(channel.send_limited(6, 2, is_even), 1U) << "2 makes room";
  EXPECT_EQ(channel.send_limited(3, 2, is_even), 0U);
  EXPECT_EQ(channel.send_limited(5, 2, is_even), 0U);
  EXPECT_EQ(channel.send_limited(7, 2, is_even), 1U) << "the channel is full";
  channel.close();
  EXPECT_EQ(channel.send_limited(8, 2, is_even), 1U) << "the channel is closed";
  for (const int x : {1, 4, 6, 3, 5}) EXPECT_EQ(channel.receive(), x);
  EXPECT_FALSE(channel.receive());
}

TEST(StageThread, DestructionDoesNotWaitForAMessageThatIsNeverSent) {
  Channel<int> in(1);
  Channel<int> out(1);
  {
    const StageThread<int, int> stage(in, out, [](int x) { return x; });
  }
  EXPECT_FALSE(in.send(1));
}

TEST(StageThread, DestructionDoesNotWaitForAReaderThatHasLeft) {
  Channel<int> in(10);
  Channel<int> out(1);
  for (int i = 0; i < 10; ++i) in.send(i);
  {
    const StageThread<int, int> stage(in, out, [](int x) { return x; });
  }
  EXPECT_FALSE(in.send(1));
}

}  // namespace
}  // namespace samewhere::core
