#pragma once

namespace samewhere::core {

// Lowers the scheduling priority of the calling thread and of those that it starts, for work whose
// result is needed late, if at all. Repeated calls change nothing. Does nothing where the system
// has no thread priorities, or refuses.
void work_in_background();

}  // namespace samewhere::core
