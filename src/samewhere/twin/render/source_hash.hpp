#pragma once

#include <string_view>

namespace samewhere::twin {

// SHA-256, in hexadecimal digits, of every source that has a say in what pictures show (twin/,
// geometry/, core/, less their tests), of the compiler with its flags, options and definitions
// (cmake/HashedBuild.cmake), and of the versions of Embree, OpenCV and Eigen. Computed at build
// time (cmake/WriteSourceHash.cmake).
std::string_view source_hash();

}  // namespace samewhere::twin
