#pragma once

#include <chrono>
#include <string>

namespace samewhere::core {

// A progress line on stderr. On a terminal it is redrawn in place; elsewhere (a log file) it is
// printed at every tenth. Silent for work that takes less than half a second.
class Progress {
 public:
  // Quiet: without a line, for a command that was asked to print none.
  Progress(std::string what, int total, bool is_quiet = false);

  // `done` items of `total` are finished.
  void update(int done);
  // Ends the line. Called by the destructor too.
  void finish();

  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

 private:
  void draw(int done, double elapsed_s);

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
