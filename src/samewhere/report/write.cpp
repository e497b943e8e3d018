#include <samewhere/core/file.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/report/frames.hpp>
#include <samewhere/report/html.hpp>
#include <samewhere/report/ply.hpp>
#include <samewhere/report/timing_json.hpp>
#include <samewhere/report/write.hpp>

namespace samewhere::report {
namespace {

void write_common(const RunRecord& record, const std::filesystem::path& folder) {
  core::write_file(folder / "loops.json", loops_json(record.ledger, record.is_scale_unknown));
  core::write_file(folder / "config.yaml", record.config_yaml);
  core::write_file(folder / "timing.json", timing_json(record.timings, core::peak_memory_mib()));
  core::write_file(folder / "report.html", report_html(record));
}

}  // namespace

void write_run(const RunRecord& record, const std::filesystem::path& folder) {
  core::write_file(folder / "trajectory.tum", core::tum_text(measured_trajectory(record.frames)));
  core::write_file(folder / "odometry.tum", core::tum_text(record.odometry));
  core::write_file(folder / "frames.csv", frames_csv(record.frames));
  core::write_file(folder / "map.ply", ply_bytes(record.points));
  write_common(record, folder);
}

void write_recognition(const RunRecord& record, const std::vector<ScoredPair>& matches,
                       const std::vector<ScoredPair>& accepted,
                       const std::filesystem::path& folder) {
  core::write_file(folder / "matches.txt", pairs_text(matches));
  core::write_file(folder / "accepted.txt", pairs_text(accepted));
  write_common(record, folder);
}

}  // namespace samewhere::report
