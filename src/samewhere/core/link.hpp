#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <utility>

#include <samewhere/core/channel.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/stage_thread.hpp>
#include <samewhere/core/timing.hpp>

namespace samewhere::core {

// The caller's side of a stage: messages go in, answers come out, both in order. Stage and caller
// agree on the number of answers per message.
template <class Message, class Answer>
class Link {
 public:
  using Reply = std::function<void(Answer)>;
  // What the stage does with a message. It may go on working after its last reply.
  using Serve = std::function<void(Message, const Reply&)>;

  virtual ~Link() = default;
  virtual void send(Message message) = 0;
  // The next answer; waits for it. Throws what the stage threw.
  virtual Answer receive() = 0;
  // Whether receive() would not wait. For what is live: a run that asks is not repeatable.
  virtual bool is_ready() const = 0;
  // Ends the stage when it has done all that was sent. Throws what the stage threw.
  virtual void finish() = 0;
  // Processor time of the stage outside of the caller's thread. After finish().
  virtual double processor_ms() const = 0;
};

// The stage runs in the caller's thread: send() returns when the message is processed; answers wait
// until they are received.
template <class Message, class Answer>
class DirectLink : public Link<Message, Answer> {
 public:
  using typename Link<Message, Answer>::Serve;
  explicit DirectLink(Serve serve) : serve_(std::move(serve)) {}

  void send(Message message) override {
    serve_(std::move(message), [this](Answer answer) { answers_.push_back(std::move(answer)); });
  }
  Answer receive() override {
    require(!answers_.empty(), "an answer is asked for that is to come");
    Answer answer = std::move(answers_.front());
    answers_.pop_front();
    return answer;
  }
  bool is_ready() const override { return !answers_.empty(); }
  void finish() override {}
  double processor_ms() const override { return 0.0; }

 private:
  Serve serve_;
  std::deque<Answer> answers_;
};

// For tests: called in the stage's thread before each message is served and before each answer is
// given; `number` counts both together.
using StageHook = std::function<void(std::uint64_t number)>;

// The stage works in a thread of its own. No more than `capacity` messages are sent whose answers
// were not received, so that no side ever waits for room. The destructor waits until the stage has
// processed what was sent; its answers are dropped.
template <class Message, class Answer>
class ThreadLink : public Link<Message, Answer> {
 public:
  using typename Link<Message, Answer>::Serve;
  ThreadLink(Serve serve, std::size_t capacity, StageHook hook)
      : serve_(std::move(serve)),
        hook_(std::move(hook)),
        messages_(capacity),
        answers_(capacity),
        worker_([this] { work(); }) {}
  ThreadLink(const ThreadLink&) = delete;
  ThreadLink& operator=(const ThreadLink&) = delete;
  ~ThreadLink() override { close(); }

  void send(Message message) override {
    if (!messages_.send(std::move(message))) fail();
  }
  Answer receive() override {
    std::optional<Answer> answer = answers_.receive();
    if (!answer) fail();
    return std::move(*answer);
  }
  bool is_ready() const override { return answers_.is_ready(); }
  void finish() override {
    messages_.close();
    worker_.join();
  }
  double processor_ms() const override { return processor_ms_; }

 private:
  void work() {
    const Closing closing{*this};
    std::uint64_t number = 0;
    const auto reply = [&](Answer answer) {
      if (hook_) hook_(number++);
      answers_.send(std::move(answer));
    };
    while (std::optional<Message> message = messages_.receive()) {
      if (hook_) hook_(number++);
      serve_(std::move(*message), reply);
    }
    processor_ms_ = thread_processor_ms();
  }

  [[noreturn]] void fail() {
    worker_.join();
    throw ContractError("a stage that has ended is asked no more");
  }

  void close() {
    messages_.close();
    answers_.close();
  }

  struct Closing {
    ThreadLink& link;
    ~Closing() { link.close(); }
  };

  Serve serve_;
  StageHook hook_;
  Channel<Message> messages_;
  Channel<Answer> answers_;
  double processor_ms_ = 0.0;
  WorkerThread worker_;  // last: starts when all above is ready, ends before it
};

}  // namespace samewhere::core
