#include <utility>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/report/frames.hpp>
#include <samewhere/report/html.hpp>
#include <samewhere/report/ply.hpp>
#include <samewhere/report/timing_json.hpp>
#include <samewhere/report/write.hpp>

namespace samewhere::report {
namespace {

// Writes files into a folder and goes on after one that cannot be written.
class Writer {
 public:
  explicit Writer(const std::filesystem::path& folder) : folder_(folder) {}

  void write(const char* name, const std::string& content) {
    try {
      core::replace_file(folder_ / name, content);
    } catch (const core::InputError& error) {
      errors_.emplace_back(error.what());
    }
  }
  std::vector<std::string> errors() { return std::move(errors_); }

 private:
  const std::filesystem::path& folder_;
  std::vector<std::string> errors_;
};

}  // namespace

std::vector<std::string> write_run(const RunRecord& record, const std::filesystem::path& folder) {
  Writer writer(folder);
  writer.write("trajectory.tum", core::tum_text(measured_trajectory(record.frames)));
  writer.write("loops.json", loops_json(record.ledger, record.is_scale_unknown));
  writer.write("frames.csv", frames_csv(record.frames));
  writer.write("config.yaml", record.config_yaml);
  writer.write("odometry.tum", core::tum_text(record.odometry));
  writer.write("report.html", report_html(record));
  writer.write("map.ply", ply_bytes(record.points));
  writer.write("timing.json", timing_json(record.timings, core::peak_memory_mib()));
  return writer.errors();
}

std::vector<std::string> write_recognition(const RunRecord& record,
                                           const std::vector<ScoredPair>& matches,
                                           const std::vector<ScoredPair>& accepted,
                                           const std::filesystem::path& folder) {
  Writer writer(folder);
  writer.write("accepted.txt", pairs_text(accepted));
  writer.write("matches.txt", pairs_text(matches));
  writer.write("loops.json", loops_json(record.ledger, record.is_scale_unknown));
  writer.write("config.yaml", record.config_yaml);
  writer.write("report.html", report_html(record));
  writer.write("timing.json", timing_json(record.timings, core::peak_memory_mib()));
  return writer.errors();
}

}  // namespace samewhere::report
