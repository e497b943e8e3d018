#include <algorithm>
#include <chrono>

#include <samewhere/view/pace.hpp>

namespace samewhere::view {
namespace {

constexpr double kPaceLook_s = 0.02;
constexpr double kMaxGap_s = 2.0;  // a longer one in the recording is not waited for

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

bool Pace::is_due(double stamp_s) {
  const bool may_go = wish_.with([](PaceWish& wish) {
    if (!wish.is_paused) return true;
    if (wish.num_steps <= 0) return false;
    --wish.num_steps;
    return true;
  });
  if (!may_go) return false;
  const PaceWish wish = get();
  if (wish.is_paused || wish.speed <= 0.0 || last_s_ < 0.0) return true;
  const double gap_s = std::clamp(stamp_s - last_stamp_s_, 0.0, kMaxGap_s);
  return now_s() - last_s_ >= gap_s / wish.speed;
}

void Pace::wait(double stamp_s, const std::function<bool()>& is_over) {
  while (!is_due(stamp_s) && !is_over()) never_.is_open_for(kPaceLook_s);
  last_stamp_s_ = stamp_s;
  last_s_ = now_s();
}

}  // namespace samewhere::view
