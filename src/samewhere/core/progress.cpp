#include <algorithm>
#include <cstdint>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

#include <samewhere/core/progress.hpp>
#include <samewhere/core/terminal.hpp>

namespace samewhere::core {
namespace {

constexpr double kQuiet_s = 0.5;
constexpr double kRedraw_s = 0.1;
constexpr double kLogged_s = 60.0;
constexpr int kBarWidth = 16;

// Not fmt::print: it throws where stderr cannot be written, and a progress line is not worth the
// run.
void print_to_stderr(const std::string& text) { std::fputs(text.c_str(), stderr); }

std::string bar(int done, int total) {
  const int filled =
      static_cast<int>(static_cast<std::int64_t>(kBarWidth) * done / std::max(total, 1));
  return fmt::format("[{:#<{}}{:.<{}}] ", "", filled, "", kBarWidth - filled);
}

std::string time_left(int num_left, double per_second) {
  if (per_second <= 0.0) return "?";
  const double left_s = num_left / per_second;
  if (left_s < 100.0) return fmt::format("{:.0f} s", left_s);
  return left_s < 6000.0 ? fmt::format("{:.0f} min", left_s / 60.0)
                         : fmt::format("{:.1f} h", left_s / 3600.0);
}

}  // namespace

Progress::Progress(std::string what, int total, bool is_quiet)
    : what_(std::move(what)),
      total_(total),
      is_quiet_(is_quiet),
      is_terminal_(isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()) {}

Progress::~Progress() { finish(); }

void Progress::update(int done, std::string_view note) {
  done = total_ > 0 ? std::clamp(done, 0, total_) : std::max(done, 0);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
  const double elapsed_s = elapsed.count();
  if (is_quiet_ || total_ < 0 || elapsed_s < kQuiet_s || !is_due(done, elapsed_s)) return;
  if (total_ > 0) last_tenth_ = 10 * done / total_;
  last_draw_s_ = elapsed_s;
  draw(done, elapsed_s, note);
}

bool Progress::is_due(int done, double elapsed_s) const {
  const double since_s = elapsed_s - last_draw_s_;
  if (is_terminal_) return since_s >= kRedraw_s || (total_ > 0 && done == total_);
  return total_ > 0 ? 10 * done / total_ > last_tenth_ : since_s >= kLogged_s;
}

void Progress::draw(int done, double elapsed_s, std::string_view note) {
  const double per_second = done / elapsed_s;
  std::string line = total_ > 0
                         ? fmt::format("{} {}/{}  {:.1f} per s  {} left", what_, done, total_,
                                       per_second, time_left(total_ - done, per_second))
                         : fmt::format("{} {}  {:.1f} per s", what_, done, per_second);
  if (!note.empty()) line += fmt::format("  {}", note);
  if (is_terminal_) {
    if (total_ > 0) line = bar(done, total_) + line;
    // a line that wraps could not be redrawn
    if (const std::size_t width = stderr_width(); width > 0 && line.size() >= width)
      line.resize(width - 1);
    print_to_stderr(fmt::format("\r\x1b[2K{}", line));
    std::fflush(stderr);
  } else {
    print_to_stderr(line + "\n");
  }
  has_drawn_ = true;
}

void Progress::finish() {
  if (has_drawn_ && is_terminal_) print_to_stderr("\n");
  has_drawn_ = false;
}

}  // namespace samewhere::core
