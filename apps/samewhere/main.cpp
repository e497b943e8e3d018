#include <sstream>
#include <string>

#include "commands.hpp"
#include "options.hpp"
#include <samewhere/core/program.hpp>
#include <samewhere/core/terminal.hpp>

namespace samewhere::app {
namespace {

void add_commands(CLI::App& app, int& exit_code) {
  add_run_command(app, exit_code);
  add_loops_command(app, exit_code);
  add_eval_command(app);
  add_dense_command(app);
  add_export_command(app);
  add_compare_command(app);
  add_bench_command(app, exit_code);
  add_info_command(app);
  add_convert_command(app);
  add_twin_command(app);
  add_view_command(app);
  add_ledger_command(app);
  add_map_command(app);
  add_optimize_command(app);
  add_config_command(app);
  add_calibrate_command(app);
  add_train_command(app);
  add_dds_command(app);
  add_doctor_command(app);
}

int run(int argc, char** argv) {
  CLI::App app("Visual SLAM that rejects false loop closures caused by perceptual aliasing");
  app.set_version_flag("--version", "samewhere " SAMEWHERE_VERSION);
  app.require_subcommand(1);
  app.footer(
      "`samewhere COMMAND --help` shows examples. Start with: samewhere run twin:twin-corridors");
  int exit_code = core::kDone;
  add_commands(app, exit_code);
  refuse_empty_values(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // help and version are no errors
      std::ostringstream text;
      const int exit_code_of_help = app.exit(error, text, text);
      core::print_text(text.str());
      return exit_code_of_help;
    }
    return core::complain("samewhere",
                          unknown_command(app).value_or(error.what()) + " (see samewhere --help)",
                          core::kBadInput);
  }
  return exit_code;
}

}  // namespace
}  // namespace samewhere::app

int main(int argc, char** argv) {
  using namespace samewhere;
  return core::run_program("samewhere", [&] { return app::run(argc, argv); });
}
