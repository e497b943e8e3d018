#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace samewhere::core {

// A progress line on stderr: items done, rate, time left. On a terminal it is redrawn in place, at
// most as wide as that; elsewhere (a log file) it is printed at every tenth, or each minute where
// the total is unknown. Silent for work that takes less than half a second.
class Progress {
 public:
  // total 0: unknown, as of a camera. Quiet: without a line, for a command that was asked to print
  // none.
  Progress(std::string what, int total, bool is_quiet = false);

  // `done` items of `total` are finished. `note`: what else is to be known, "tracking, 2 loops".
  void update(int done, std::string_view note = {});
  // Ends the line. Called by the destructor too.
  void finish();

  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

 private:
  bool is_due(int done, double elapsed_s) const;
  void draw(int done, double elapsed_s, std::string_view note);

  std::string what_;
  int total_;
  bool is_quiet_;
  bool is_terminal_;
  bool has_drawn_ = false;
  int last_tenth_ = 0;
  double last_draw_s_ = 0.0;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace samewhere::core
