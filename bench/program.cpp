#include "program.hpp"

#include <cstdio>
#include <filesystem>

#include <samewhere/core/file.hpp>
#include <samewhere/core/program.hpp>

namespace samewhere::bench {

int run_program(int argc, char** argv, SetUp set_up) noexcept {
  const std::string name = std::filesystem::path(argv[0]).filename().string();
  return core::run_program(name, [&] {
    CLI::App app;
    const std::function<void()> work = set_up(app);
    try {
      app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      // help is no error
      if (error.get_exit_code() == 0) return app.exit(error);
      return core::complain(app.get_name(), std::string(error.what()) + " (see --help)",
                            core::kBadInput);
    }
    work();
    return core::kDone;
  });
}

void publish(const Table& table, const std::string& csv_file) {
  std::fputs(as_text(table).c_str(), stdout);
  if (!csv_file.empty()) core::write_file(csv_file, as_csv(table));
}

}  // namespace samewhere::bench
