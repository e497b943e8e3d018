#pragma once

#include <memory>
#include <string>
#include <vector>

#include <samewhere/paper/methods/method.hpp>
#include <samewhere/pipeline/config.hpp>

namespace samewhere::paper {

// What a table says of a method.
struct MethodInfo {
  std::string name;      // as --methods has it
  std::string title;     // as the columns of the tables have it
  std::string what_ran;  // one sentence: the features, the search, the check, the threshold
};

// The detectors that there are, in the order of the tables.
const std::vector<MethodInfo>& known_methods();

// Of this name. `base` is the config of the command line: source, seed and window, in frames.
// Throws InputError naming the known ones if it is none of them, and on a file that it needs and
// that is not there.
std::unique_ptr<Method> make_method(const std::string& name, const pipeline::Config& base);

}  // namespace samewhere::paper
