#pragma once

namespace samewhere::train {

// `samewhere-train pairs ARGUMENT...`; the exit status.
int train_pairs(int argc, char** argv);

}  // namespace samewhere::train
