#pragma once

#include <deque>
#include <exception>
#include <functional>
#include <optional>
#include <utility>

#include <samewhere/core/channel.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/stage_thread.hpp>

namespace samewhere::core {

// Makes items 0, 1, 2, ... on several threads and gives them out in order: worker i makes those
// that are i modulo the number of workers, at most two ahead of what was asked for. What
// make(index) returns must depend on the index alone; then the items do not depend on the workers.
// May be destroyed at any time: items in the making are finished first.
template <class Item>
class OrderedWorkers {
 public:
  // `make` is called by all workers at once. Throws InputError if the system refuses a thread.
  OrderedWorkers(int num_items, int num_workers, std::function<Item(int)> make)
      : num_items_(num_items), make_(std::move(make)) {
    require(num_workers > 0, "items are made by at least one worker");
    constexpr std::size_t kAhead = 1;  // ready, beside the one in the making
    for (int i = 0; i < num_workers; ++i) channels_.emplace_back(kAhead);
    try {
      for (int i = 0; i < num_workers; ++i) workers_.emplace_back([this, i] { run(i); });
    } catch (...) {  // those that run are waited for, and must not wait for us
      close_all();
      throw;
    }
  }
  OrderedWorkers(const OrderedWorkers&) = delete;
  OrderedWorkers& operator=(const OrderedWorkers&) = delete;
  ~OrderedWorkers() { close_all(); }

  // The next item, or nothing at the end. Throws what make() threw for it; no items come after
  // that.
  std::optional<Item> next() {
    if (next_ == num_items_) return std::nullopt;
    auto made = channels_[static_cast<std::size_t>(next_) % channels_.size()].receive();
    require(made.has_value(), "a worker answers for each of its items");
    if (made->error) {
      next_ = num_items_;
      std::rethrow_exception(made->error);
    }
    ++next_;
    return std::move(made->item);
  }

 private:
  struct Made {
    std::optional<Item> item;
    std::exception_ptr error;
  };

  void close_all() {
    for (auto& channel : channels_) channel.close();
  }

  Made made(int index) const {
    try {
      return {.item = make_(index), .error = nullptr};
    } catch (...) {
      return {.item = std::nullopt, .error = std::current_exception()};
    }
  }

  void run(int first) {
    const int num_workers = static_cast<int>(channels_.size());
    for (int index = first; index < num_items_; index += num_workers) {
      Made result = made(index);
      const bool has_failed = result.error != nullptr;
      if (!channels_[static_cast<std::size_t>(first)].send(std::move(result)) || has_failed) return;
    }
  }

  int num_items_;
  int next_ = 0;
  std::function<Item(int)> make_;
  std::deque<Channel<Made>> channels_;
  std::deque<WorkerThread> workers_;  // last: they end before what they use
};

}  // namespace samewhere::core
