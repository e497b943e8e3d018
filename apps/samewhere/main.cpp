#include <cstdio>
#include <exception>
#include <string>

#include <opencv2/core/utility.hpp>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include "commands.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/interrupt.hpp>

namespace samewhere::app {
namespace {

// One line, whatever the library put into the message.
int complain(std::string message, int exit_code) {
  for (char& c : message) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  // not fmt::print, which throws where stderr is closed
  std::fputs(("samewhere: " + message + "\n").c_str(), stderr);
  return exit_code;
}

int run(int argc, char** argv) {
  CLI::App app("Visual SLAM that knows when two places only look the same");
  app.set_version_flag("--version", "samewhere " SAMEWHERE_VERSION);
  app.require_subcommand(1);
  app.footer(
      "`samewhere COMMAND --help` shows examples. Start with: samewhere run twin:twin-corridors");
  int exit_code = kDone;
  add_run_command(app, exit_code);
  add_loops_command(app, exit_code);
  add_eval_command(app);
  add_bench_command(app, exit_code);
  add_twin_command(app);
  add_config_command(app);
  add_train_command(app);
  add_doctor_command(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // help and version are no errors
    if (error.get_exit_code() == 0) return app.exit(error);
    return complain(std::string(error.what()) + " (see samewhere --help)", kBadInput);
  }
  return exit_code;
}

}  // namespace
}  // namespace samewhere::app

int main(int argc, char** argv) {
  using namespace samewhere;
  // parallelism is between stages, and the same bits come out on any number of cores
  cv::setNumThreads(1);
  // results go to stdout, and nothing else does
  spdlog::set_default_logger(spdlog::stderr_logger_st("samewhere"));
  spdlog::set_pattern("%n: %l: %v");
  try {
    return app::run(argc, argv);
  } catch (const core::InputError& error) {
    return app::complain(error.what(), app::kBadInput);
  } catch (const core::Interrupted&) {
    return app::kInterrupted;
  } catch (const std::exception& error) {
    return app::complain(std::string("this is a bug of ours: ") + error.what(),
                         app::kBrokenPromise);
  }
}
