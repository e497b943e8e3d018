#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <samewhere/core/link.hpp>

namespace samewhere::core {
namespace {

using TestLink = Link<int, std::string>;

// Answers n times to the message n.
void answer_as_often(int message, const TestLink::Reply& reply) {
  for (int i = 0; i < message; ++i) reply(std::to_string(message) + "." + std::to_string(i));
}

void fail_at_3(int message, const TestLink::Reply& reply) {
  if (message == 3) throw std::runtime_error("three is too many");
  reply(std::to_string(message));
}

std::vector<std::unique_ptr<TestLink>> both_links(const TestLink::Serve& serve,
                                                  std::size_t capacity = 4) {
  std::vector<std::unique_ptr<TestLink>> links;
  links.push_back(std::make_unique<DirectLink<int, std::string>>(serve));
  links.push_back(std::make_unique<ThreadLink<int, std::string>>(serve, capacity, StageHook{}));
  return links;
}

TEST(Link, AnswersComeInTheOrderOfTheMessagesAsManyAsAgreed) {
  for (const auto& link : both_links(answer_as_often)) {
    for (const int message : {2, 0, 1}) link->send(message);
    EXPECT_EQ(link->receive(), "2.0");
    EXPECT_EQ(link->receive(), "2.1");
    EXPECT_EQ(link->receive(), "1.0");
    link->finish();
  }
}

TEST(Link, AStageGoesOnAfterItsAnswerAndIsDoneWhenItIsFinished) {
  int num_done = 0;
  const auto serve = [&](int message, const TestLink::Reply& reply) {
    reply("soon");
    num_done += message;
  };
  for (const auto& link : both_links(serve)) {
    num_done = 0;
    link->send(7);
    link->send(5);
    EXPECT_EQ(link->receive(), "soon");
    link->finish();
    EXPECT_EQ(num_done, 12);
    EXPECT_EQ(link->receive(), "soon") << "what was answered is still there";
  }
}

TEST(Link, AnExceptionOfTheStageComesOutAndNoSideWaitsForever) {
  for (const auto& link : both_links(fail_at_3)) {
    const auto talk = [&] {
      for (int i = 0; i < 1000; ++i) {
        link->send(i);
        link->receive();
      }
    };
    EXPECT_THROW(talk(), std::runtime_error);
  }
  ThreadLink<int, std::string> link(fail_at_3, 1, {});
  link.send(3);
  EXPECT_THROW(link.finish(), std::runtime_error) << "the answer was not received";
}

TEST(Link, AStageThatHasEndedIsAskedNoMore) {
  ThreadLink<int, std::string> link(fail_at_3, 1, {});
  link.send(3);
  EXPECT_THROW(link.receive(), std::runtime_error);
  EXPECT_THROW(link.receive(), ContractError);
  EXPECT_THROW(link.send(1), ContractError);
  DirectLink<int, std::string> direct(fail_at_3);
  EXPECT_THROW(direct.receive(), ContractError) << "in turn this would wait forever";
}

TEST(Link, DestructionWithUnreceivedAnswersDoesNotHang) {
  const TestLink::Serve busy = [](int /*message*/, const TestLink::Reply& reply) {
    for (int i = 0; i < 100; ++i) reply("more than there is room for");
  };
  ThreadLink<int, std::string> link(busy, 1, {});
  link.send(1);
}

TEST(Link, TheProcessorTimeOfAThreadIsItsOwn) {
  const auto work = [](int message, const TestLink::Reply& reply) {
    double sum = 0.0;
    for (int i = 0; i < 1'000'000 * message; ++i) sum += std::sqrt(static_cast<double>(i));
    reply(std::to_string(sum));
  };
  ThreadLink<int, std::string> threaded(work, 1, {});
  DirectLink<int, std::string> direct(work);
  for (TestLink* link : {static_cast<TestLink*>(&threaded), static_cast<TestLink*>(&direct)}) {
    link->send(3);
    link->finish();
  }
  EXPECT_GT(threaded.processor_ms(), 0.5);
  EXPECT_EQ(direct.processor_ms(), 0.0) << "it is in the customer's";
}

}  // namespace
}  // namespace samewhere::core
