#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>

#include <opencv2/core/utility.hpp>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/printable.hpp>
#include <samewhere/core/program.hpp>
#include <samewhere/core/terminal.hpp>

namespace samewhere::core {
namespace {

Severity severity_of(spdlog::level::level_enum level) {
  if (level < spdlog::level::warn) return Severity::kInfo;
  return level == spdlog::level::warn ? Severity::kWarning : Severity::kError;
}

// "NAME: LEVEL: MESSAGE", in one line that a terminal only shows.
class PrintableFormatter : public spdlog::formatter {
 public:
  void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& line) override {
    const std::string_view payload(message.payload.data(), message.payload.size());
    const std::string clean = printable_line(payload, kMaxMessage);
    spdlog::details::log_msg shown = message;
    shown.payload = clean;
    spdlog::memory_buf_t plain;
    pattern_.format(shown, plain);
    std::string_view text(plain.data(), plain.size());
    if (text.ends_with('\n')) text.remove_suffix(1);
    const std::string whole = line_for_stderr(text, severity_of(message.level)) + "\n";
    line.append(whole.data(), whole.data() + whole.size());
  }

  std::unique_ptr<spdlog::formatter> clone() const override {
    return std::make_unique<PrintableFormatter>();
  }

 private:
  spdlog::pattern_formatter pattern_{"%n: %l: %v"};
};

void log_to_stderr(const std::string& name) {
  auto logger =
      std::make_shared<spdlog::logger>(name, std::make_shared<spdlog::sinks::stderr_sink_mt>());
  logger->set_formatter(std::make_unique<PrintableFormatter>());
  spdlog::set_default_logger(std::move(logger));
}

// Of a reader that has gone, as `head` does, nothing is said.
int finish(const std::string& name, int exit_code) {
  const int error = finish_standard_output();
  if (error == 0) return exit_code;
  if (error != EPIPE)
    complain(name, std::string("standard output: cannot be written: ") + std::strerror(error), 0);
  return exit_code == kDone ? kBadInput : exit_code;
}

int guarded(const std::string& name, const std::function<int()>& work) {
  try {
    return work();
  } catch (const InputError& error) {
    return complain(name, error.what(), kBadInput);
  } catch (const Interrupted&) {
    return kInterruptedExit;
  } catch (const std::exception& error) {
    return complain(name, std::string("this is a bug: ") + error.what(), kBrokenPromise);
  }
}

}  // namespace

void note(const std::string& message) {
  std::fputs((printable_line(message, kMaxMessage) + "\n").c_str(), stderr);
}

int complain(const std::string& name, const std::string& message, int exit_code) {
  // not fmt::print, which throws where stderr is closed
  const std::string line = name + ": " + printable_line(message, kMaxMessage);
  std::fputs((line_for_stderr(line, Severity::kError) + "\n").c_str(), stderr);
  return exit_code;
}

int run_program(const std::string& name, const std::function<int()>& work) noexcept {
  try {
    occupy_standard_streams();
    cv::setNumThreads(1);
    std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error of its writer
    std::signal(SIGPIPE, SIG_IGN);  // a run writes its results although its output is read no more
    log_to_stderr(name);
    return finish(name, guarded(name, work));
  } catch (...) {
    return kBrokenPromise;  // not even a message could be made
  }
}

}  // namespace samewhere::core
