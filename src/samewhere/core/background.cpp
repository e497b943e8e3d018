#include <utility>

#include <samewhere/core/background.hpp>

#ifdef __linux__
#include <sys/resource.h>
#include <unistd.h>
#endif

namespace samewhere::core {

void work_in_background() {
#ifdef __linux__
  constexpr int kNicer = 10;  // a tenth of the share of the threads that it gives way to
  static thread_local bool gives_way = false;
  if (std::exchange(gives_way, true)) return;
  // getpriority(2): on Linux of one thread, by its id; what lies beyond the range is cut to it
  const auto self = static_cast<id_t>(gettid());
  setpriority(PRIO_PROCESS, self, getpriority(PRIO_PROCESS, self) + kNicer);
#endif
}

}  // namespace samewhere::core
