#pragma once

#include <deque>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/stage_thread.hpp>

namespace samewhere::core {

// Calls work(i) for 0 <= i < count on so many threads, the caller's among them: on one, no other is
// started. What work(i) does must not depend on the others. Throws what work throws; of several the
// caller's first.
template <class Work>
void share_out(int count, int num_threads, const Work& work) {
  require(num_threads > 0, "work is shared out to at least one thread");
  const auto do_share = [&work, count, num_threads](int first) {
    for (int i = first; i < count; i += num_threads) work(i);
  };
  std::deque<WorkerThread> threads;
  for (int first = 1; first < num_threads; ++first) {
    threads.emplace_back([&do_share, first] { do_share(first); });
  }
  do_share(0);
  for (auto& thread : threads) thread.join();
}

}  // namespace samewhere::core
