#include <algorithm>
#include <cmath>

#include <samewhere/core/nanoseconds.hpp>

namespace samewhere::core {
namespace {

constexpr std::int64_t kPerSecond = 1'000'000'000;

}  // namespace

std::int64_t nanoseconds_of(double seconds) {
  constexpr double kMost_s = 9.2e9;
  const double bounded_s = std::clamp(seconds, -kMost_s, kMost_s);
  const double whole_s = std::floor(bounded_s);
  return static_cast<std::int64_t>(whole_s) * kPerSecond +
         std::llround((bounded_s - whole_s) * static_cast<double>(kPerSecond));
}

// The quotient is rounded once in the 64 bits of a long double and once to a double.
double seconds_of(std::int64_t nanoseconds) {
  return static_cast<double>(static_cast<long double>(nanoseconds) /
                             static_cast<long double>(kPerSecond));
}

double in_whole_nanoseconds(double seconds) { return seconds_of(nanoseconds_of(seconds)); }

}  // namespace samewhere::core
