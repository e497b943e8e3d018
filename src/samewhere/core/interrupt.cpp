#include <csignal>

#include <samewhere/core/interrupt.hpp>

namespace samewhere::core {
namespace {

volatile std::sig_atomic_t interrupted = 0;

void set_handler(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

// `nohup` starts programs so, which then survive their terminal.
bool is_hangup_ignored() {
  struct sigaction action {};
  return sigaction(SIGHUP, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

// A terminal that is closed sends SIGHUP, and its shell another one, which is not impatience.
void note_interrupt(int /*signal*/) {
  interrupted = 1;
  set_handler(SIGINT, SIG_DFL);
  set_handler(SIGTERM, SIG_DFL);
  set_handler(SIGHUP, SIG_IGN);
}

}  // namespace

void catch_interrupts() {
  interrupted = 0;
  set_handler(SIGINT, note_interrupt);
  set_handler(SIGTERM, note_interrupt);
  if (!is_hangup_ignored()) set_handler(SIGHUP, note_interrupt);
}

bool is_interrupted() { return interrupted != 0; }

void stop_if_interrupted() {
  if (is_interrupted()) throw Interrupted();
}

}  // namespace samewhere::core
