#pragma once

#include <filesystem>
#include <string>

namespace samewhere::core {

// The models that come with the program: share/samewhere/models of the installed one, models/ of
// the source tree.
std::filesystem::path models_folder();

// A file that came out of training. A name without a slash is one of those that come with the
// program (share/samewhere/models of the installed one, models/ of the source tree), or else a file
// of the working directory: what lies there by chance is never taken for a shipped one, and a
// warning says where both exist. With a slash it is the path itself. Throws InputError naming the
// setting, both places and what was expected ("an ONNX network") if it is in neither.
std::filesystem::path find_model(const std::string& setting, const std::string& file,
                                 const std::string& expected);

}  // namespace samewhere::core
