#include <algorithm>
#include <cmath>

#include <samewhere/messages/messages.hpp>

namespace samewhere::messages {
namespace {

constexpr std::int64_t kPerSecond = 1'000'000'000;

}  // namespace

std::int64_t nanoseconds(const Time& time) {
  return std::int64_t{time.sec} * kPerSecond + std::int64_t{time.nanosec};
}

Time time_of_nanoseconds(std::int64_t nanoseconds) {
  std::int64_t sec = nanoseconds / kPerSecond;
  std::int64_t rest = nanoseconds % kPerSecond;
  if (rest < 0) {
    rest += kPerSecond;
    --sec;
  }
  return {static_cast<std::int32_t>(sec), static_cast<std::uint32_t>(rest)};
}

// The quotient is rounded once in the 64 bits of a long double and once to a double: that is the
// double nearest to the decimal number, which reading its text gives, too.
double seconds(const Time& time) {
  return static_cast<double>(static_cast<long double>(nanoseconds(time)) /
                             static_cast<long double>(kPerSecond));
}

Time time_of(double seconds) {
  constexpr double kMost_s = 2147483647.0;
  const double whole = std::floor(std::clamp(seconds, -kMost_s, kMost_s));
  const auto rest = std::llround((std::clamp(seconds, -kMost_s, kMost_s) - whole) * 1e9);
  return time_of_nanoseconds(static_cast<std::int64_t>(whole) * kPerSecond + rest);
}

}  // namespace samewhere::messages
