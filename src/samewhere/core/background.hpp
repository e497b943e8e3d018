#pragma once

namespace samewhere::core {

// From now on the calling thread, and those that it starts, give way to all others of the machine
// where there are fewer processors than work: for what is waited for late, if at all. That it
// asks again changes nothing. Does nothing where the system has no priorities of threads, or
// refuses.
void work_in_background();

}  // namespace samewhere::core
