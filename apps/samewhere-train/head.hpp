#pragma once

namespace samewhere::train {

// `samewhere-train head ...`: the exit status. argv[1] is "head".
int run_head(int argc, char** argv);

}  // namespace samewhere::train
