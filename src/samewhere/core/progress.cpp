#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

#include <samewhere/core/progress.hpp>

namespace samewhere::core {
namespace {

constexpr double kQuiet_s = 0.5;
constexpr double kRedraw_s = 0.1;
constexpr int kBarWidth = 24;

// Not fmt::print: it throws where stderr cannot be written, and a progress line is not worth the
// run.
void print_to_stderr(const std::string& text) { std::fputs(text.c_str(), stderr); }

}  // namespace

Progress::Progress(std::string what, int total, bool is_quiet)
    : what_(std::move(what)),
      total_(total),
      is_quiet_(is_quiet),
      is_terminal_(isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()) {}

Progress::~Progress() { finish(); }

void Progress::update(int done) {
  done = std::clamp(done, 0, std::max(total_, 0));
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
  const double elapsed_s = elapsed.count();
  if (is_quiet_ || total_ <= 0 || elapsed_s < kQuiet_s) return;
  const int tenth = 10 * done / total_;
  const bool is_due =
      is_terminal_ ? elapsed_s - last_draw_s_ >= kRedraw_s || done == total_ : tenth > last_tenth_;
  if (!is_due) return;
  last_tenth_ = tenth;
  last_draw_s_ = elapsed_s;
  draw(done, elapsed_s);
}

void Progress::draw(int done, double elapsed_s) {
  const double per_second = done / elapsed_s;
  const double left_s = per_second > 0.0 ? (total_ - done) / per_second : 0.0;
  const std::string figures =
      fmt::format("{} {}/{}  {:.1f} per s  {:.0f} s left", what_, done, total_, per_second, left_s);
  if (is_terminal_) {
    const int filled = kBarWidth * done / total_;
    print_to_stderr(
        fmt::format("\r\x1b[2K[{:#<{}}{:.<{}}] {}", "", filled, "", kBarWidth - filled, figures));
    std::fflush(stderr);
  } else {
    print_to_stderr(figures + "\n");
  }
  has_drawn_ = true;
}

void Progress::finish() {
  if (has_drawn_ && is_terminal_) print_to_stderr("\n");
  has_drawn_ = false;
}

}  // namespace samewhere::core
