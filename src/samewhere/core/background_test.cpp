#include <gtest/gtest.h>

#ifdef __linux__
#include <algorithm>

#include <sys/resource.h>
#include <unistd.h>

#include <samewhere/core/background.hpp>
#include <samewhere/core/stage_thread.hpp>

namespace samewhere::core {
namespace {

int own_priority() { return getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())); }

TEST(Background, TheThreadThatAsksGivesWayAndNoOther) {
  const int before = own_priority();
  int of_worker = -100;
  WorkerThread worker([&] {
    work_in_background();
    work_in_background();  // once is enough
    of_worker = own_priority();
  });
  worker.join();
  constexpr int kNicest = 19;
  EXPECT_EQ(of_worker, std::min(before + 10, kNicest));
  EXPECT_EQ(own_priority(), before);
}

}  // namespace
}  // namespace samewhere::core
#endif
