#include <samewhere/core/background.hpp>

#ifdef __linux__
#include <sys/resource.h>
#include <unistd.h>
#endif

namespace samewhere::core {

void work_in_background() {
#ifdef __linux__
  constexpr int kNice = 10;  // a tenth of the share of a thread of nice 0
  // setpriority(2): on Linux of one thread, by its id
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice);
#endif
}

}  // namespace samewhere::core
