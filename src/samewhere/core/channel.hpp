#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

#include <samewhere/core/errors.hpp>

namespace samewhere::core {

// A bounded queue between two threads. The writer waits while it is full, the reader while it is
// empty. After close() the reader gets what is left, then nothing; a writer is told that the
// channel is closed.
template <class T>
class Channel {
 public:
  explicit Channel(std::size_t capacity) : capacity_(capacity) {
    require(capacity > 0, "a Channel holds at least one message");
  }

  // False if the channel is closed: the message is dropped.
  bool send(T message) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return is_closed_ || messages_.size() < capacity_; });
    if (is_closed_) return false;
    messages_.push_back(std::move(message));
    changed_.notify_all();
    return true;
  }

  // Replaces a waiting message, so that the reader gets the newest and the writer never waits.
  // False if the channel is closed.
  bool send_newest(T message) {
    const std::lock_guard lock(mutex_);
    if (is_closed_) return false;
    messages_.clear();
    messages_.push_back(std::move(message));
    changed_.notify_all();
    return true;
  }

  // Never waits. Of the messages that are alike at most `limit` stay: the oldest makes room.
  // Returns how many were dropped: this one if the channel is full or closed.
  template <class IsAlike>
  std::size_t send_limited(T message, std::size_t limit, const IsAlike& is_alike) {
    const std::lock_guard lock(mutex_);
    if (is_closed_) return 1;
    std::size_t num_dropped = 0;
    const auto num_alike =
        is_alike(message) ? std::count_if(messages_.begin(), messages_.end(), is_alike) : 0;
    if (num_alike > 0 && static_cast<std::size_t>(num_alike) >= limit) {
      messages_.erase(std::find_if(messages_.begin(), messages_.end(), is_alike));
      ++num_dropped;
    }
    if (messages_.size() >= capacity_) return num_dropped + 1;
    messages_.push_back(std::move(message));
    changed_.notify_all();
    return num_dropped;
  }

  // Waits so long, or until the channel is closed: then false. For a writer whose message is not
  // due.
  bool is_open_for(double seconds) {
    std::unique_lock lock(mutex_);
    return !changed_.wait_for(lock, std::chrono::duration<double>(seconds),
                              [&] { return is_closed_; });
  }

  // Nothing if the channel is closed and empty.
  std::optional<T> receive() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return is_closed_ || !messages_.empty(); });
    if (messages_.empty()) return std::nullopt;
    std::optional<T> message(std::move(messages_.front()));
    messages_.pop_front();
    changed_.notify_all();
    return message;
  }

  // Whether receive() would return at once. For what is live: a run that asks is not repeatable.
  bool is_ready() const {
    const std::lock_guard lock(mutex_);
    return is_closed_ || !messages_.empty();
  }

  void close() {
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
    changed_.notify_all();
  }

 private:
  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<T> messages_;
  bool is_closed_ = false;
};

// A value that several threads read and write, one at a time.
template <class T>
class Guarded {
 public:
  explicit Guarded(T value = {}) : value_(std::move(value)) {}

  T get() const {
    const std::lock_guard lock(mutex_);
    return value_;
  }
  void set(T value) {
    const std::lock_guard lock(mutex_);
    std::swap(value_, value);  // the old one is destroyed behind the lock
  }
  // The value before.
  T exchange(T value) {
    const std::lock_guard lock(mutex_);
    return std::exchange(value_, std::move(value));
  }
  // What `work` returns for the value, which no other thread sees meanwhile.
  template <class Work>
  auto with(const Work& work) {
    const std::lock_guard lock(mutex_);
    return work(value_);
  }

 private:
  mutable std::mutex mutex_;
  T value_;
};

}  // namespace samewhere::core
