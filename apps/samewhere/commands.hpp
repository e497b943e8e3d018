#pragma once

#include <CLI/CLI.hpp>

namespace samewhere::app {

// Each adds its command; when it was chosen, its work runs during parsing and leaves the exit code
// in `exit_code`.
void add_run_command(CLI::App& app, int& exit_code);
void add_loops_command(CLI::App& app, int& exit_code);
void add_twin_command(CLI::App& app);
void add_eval_command(CLI::App& app);
void add_dense_command(CLI::App& app);
void add_export_command(CLI::App& app);
void add_compare_command(CLI::App& app);
void add_bench_command(CLI::App& app, int& exit_code);
void add_config_command(CLI::App& app);
void add_ledger_command(CLI::App& app);
void add_map_command(CLI::App& app);
void add_optimize_command(CLI::App& app);
void add_calibrate_command(CLI::App& app);
void add_train_command(CLI::App& app);
void add_convert_command(CLI::App& app);
void add_info_command(CLI::App& app);
void add_dds_command(CLI::App& app);
void add_view_command(CLI::App& app);
void add_doctor_command(CLI::App& app);

}  // namespace samewhere::app
