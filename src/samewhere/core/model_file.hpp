#pragma once

#include <filesystem>
#include <string>

namespace samewhere::core {

// A file that came out of training: itself, relative to the working directory; failing that, in the
// folder models/ of the source that this program was built from. Throws InputError naming the
// setting, both places and what was expected ("an ONNX network") if it is in neither.
std::filesystem::path find_model(const std::string& setting, const std::string& file,
                                 const std::string& expected);

}  // namespace samewhere::core
