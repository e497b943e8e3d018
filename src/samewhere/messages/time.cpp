#include <algorithm>

#include <samewhere/core/nanoseconds.hpp>
#include <samewhere/messages/messages.hpp>

namespace samewhere::messages {
namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

}  // namespace

std::int64_t nanoseconds(const Time& time) {
  return std::int64_t{time.sec} * kNanosecondsPerSecond + std::int64_t{time.nanosec};
}

Time time_of_nanoseconds(std::int64_t nanoseconds) {
  std::int64_t sec = nanoseconds / kNanosecondsPerSecond;
  std::int64_t rest = nanoseconds % kNanosecondsPerSecond;
  if (rest < 0) {
    rest += kNanosecondsPerSecond;
    --sec;
  }
  return {static_cast<std::int32_t>(sec), static_cast<std::uint32_t>(rest)};
}

double seconds(const Time& time) { return core::seconds_of(nanoseconds(time)); }

Time time_of(double seconds) {
  constexpr double kMost_s = 2147483647.0;
  return time_of_nanoseconds(core::nanoseconds_of(std::clamp(seconds, -kMost_s, kMost_s)));
}

}  // namespace samewhere::messages
