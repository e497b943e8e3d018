#pragma once

namespace samewhere::core {

// After this, the first Ctrl-C (SIGINT) or SIGTERM only sets a flag: long loops look at it between
// frames, stop, and their files are finished. A second one ends the process at once.
void catch_interrupts();
bool is_interrupted();

}  // namespace samewhere::core
