#include <csignal>
#include <cstdio>
#include <exception>
#include <memory>

#include <opencv2/core/utility.hpp>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/program.hpp>

namespace samewhere::core {

int complain(const std::string& name, std::string message, int exit_code) {
  for (char& c : message) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  // not fmt::print, which throws where stderr is closed
  std::fputs((name + ": " + message + "\n").c_str(), stderr);
  return exit_code;
}

int run_program(const std::string& name, const std::function<int()>& work) noexcept {
  try {
    cv::setNumThreads(1);
    std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error of its writer
    spdlog::set_default_logger(
        std::make_shared<spdlog::logger>(name, std::make_shared<spdlog::sinks::stderr_sink_mt>()));
    spdlog::set_pattern("%n: %l: %v");
    try {
      return work();
    } catch (const InputError& error) {
      return complain(name, error.what(), kBadInput);
    } catch (const Interrupted&) {
      return kInterruptedExit;
    } catch (const std::exception& error) {
      return complain(name, std::string("this is a bug of ours: ") + error.what(), kBrokenPromise);
    }
  } catch (...) {
    return kBrokenPromise;  // not even a message could be made
  }
}

}  // namespace samewhere::core
