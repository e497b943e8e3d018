#include "program.hpp"

#include <cstdio>
#include <exception>

#include <opencv2/core/utility.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>

namespace samewhere::bench {
namespace {

constexpr int kBadInput = 2;
constexpr int kBrokenPromise = 3;

int complain(const CLI::App& app, const std::string& message, int exit_code) {
  std::fputs((app.get_name() + ": " + message + "\n").c_str(), stderr);
  return exit_code;
}

int parse_and_work(CLI::App& app, int argc, char** argv, SetUp set_up) {
  try {
    const std::function<void()> work = set_up(app);
    app.parse(argc, argv);
    work();
  } catch (const CLI::ParseError& error) {
    // help is no error
    if (error.get_exit_code() == 0) return app.exit(error);
    return complain(app, std::string(error.what()) + " (see --help)", kBadInput);
  } catch (const core::InputError& error) {
    return complain(app, error.what(), kBadInput);
  } catch (const std::exception& error) {
    return complain(app, std::string("this is a bug of ours: ") + error.what(), kBrokenPromise);
  }
  return 0;
}

}  // namespace

int run_program(int argc, char** argv, SetUp set_up) noexcept {
  try {
    cv::setNumThreads(1);
    CLI::App app;
    return parse_and_work(app, argc, argv, set_up);
  } catch (...) {
    return kBrokenPromise;  // not even a message could be made
  }
}

void publish(const Table& table, const std::string& csv_file) {
  std::fputs(as_text(table).c_str(), stdout);
  if (!csv_file.empty()) core::write_file(csv_file, as_csv(table));
}

}  // namespace samewhere::bench
