#include <gtest/gtest.h>

#ifdef __linux__
#include <sys/resource.h>
#include <unistd.h>

#include <samewhere/core/background.hpp>
#include <samewhere/core/stage_thread.hpp>

namespace samewhere::core {
namespace {

int priority_of_this_thread() { return getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())); }

TEST(Background, TheThreadThatAsksGivesWayAndNoOther) {
  const int before = priority_of_this_thread();
  int of_worker = -100;
  WorkerThread worker([&] {
    work_in_background();
    of_worker = priority_of_this_thread();
  });
  worker.join();
  EXPECT_GT(of_worker, before);
  EXPECT_EQ(priority_of_this_thread(), before);
}

}  // namespace
}  // namespace samewhere::core
#endif
