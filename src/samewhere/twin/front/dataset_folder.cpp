#include <iterator>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/csv.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/progress.hpp>
#include <samewhere/twin/front/dataset_folder.hpp>

namespace samewhere::twin {
namespace {

using core::InputError;
using std::filesystem::path;

// "out/", "out" and "new/../out" are the same folder, and ".partial" goes behind its name.
path plain_name(const path& folder) {
  std::error_code error;
  const path plain = std::filesystem::weakly_canonical(folder, error);
  if (error) throw InputError(folder.string() + ": cannot be found: " + error.message());
  return plain.has_filename() ? plain : plain.parent_path();
}

void require_free(const path& name, const char* why) {
  std::error_code error;
  if (!std::filesystem::exists(std::filesystem::symlink_status(name, error))) return;
  throw InputError(fmt::format("{}: {}", name.string(), why));
}

void make_folders(const path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw InputError(folder.string() + ": cannot be made: " + error.message());
}

std::string frames_csv(const std::vector<FrameTruth>& frames, const std::vector<double>& stamps_s) {
  std::string text = "frame,stamp_s,visit,room,floor\n";
  for (std::size_t i = 0; i < frames.size(); ++i) {
    fmt::format_to(std::back_inserter(text), "{},{:.9f},{},{},{}\n", i, stamps_s[i],
                   frames[i].visit, core::csv_field(frames[i].room), frames[i].floor);
  }
  return text;
}

std::string loops_csv(const std::vector<TrueLoop>& loops) {
  std::string text = "query,match,overlap,confirmable,object\n";
  for (const auto& loop : loops) {
    fmt::format_to(std::back_inserter(text), "{},{},{:.4f},{},{}\n", loop.query, loop.match,
                   loop.overlap, loop.is_confirmable ? 1 : 0, core::csv_field(loop.object));
  }
  return text;
}

std::string aliased_pairs_csv(const std::vector<AliasedPair>& aliased_pairs) {
  std::string text = "query,match,alike\n";
  for (const auto& pair : aliased_pairs) {
    fmt::format_to(std::back_inserter(text), "{},{},{:.4f}\n", pair.query, pair.match, pair.alike);
  }
  return text;
}

std::string wheels_csv(const std::vector<WheelSample>& wheels) {
  std::string text = "stamp_s,forward_m,turned_rad\n";
  for (const auto& sample : wheels) {
    fmt::format_to(std::back_inserter(text), "{:.9f},{:.9f},{:.9f}\n", sample.stamp_s,
                   sample.forward_m, sample.turned_rad);
  }
  return text;
}

template <class Values>
std::string pgm(const Values& values, std::size_t num_frames, int max_value) {
  core::require(values.size() == num_frames * num_frames, "a truth matrix is square over frames");
  std::string bytes = fmt::format("P5\n{0} {0}\n{1}\n", num_frames, max_value);
  bytes.reserve(bytes.size() + values.size());
  for (const auto value : values) bytes += static_cast<char>(value);
  return bytes;
}

}  // namespace

PartialFolder::PartialFolder(const path& folder)
    : folder_(plain_name(folder)), partial_(folder_.string() + ".partial") {
  require_free(folder_, "is there already, expected a name that is free");
  require_free(partial_, "was left by a run that was cut off (or is being written); remove it");
  make_folders(partial_);
}

PartialFolder::~PartialFolder() {
  if (is_finished_) return;
  std::error_code ignored;  // on the way out of an error, which is the one to be told
  std::filesystem::remove_all(partial_, ignored);
}

void PartialFolder::write(const path& name, std::string_view content) const {
  make_folders((partial_ / name).parent_path());
  core::write_file(partial_ / name, content);
}

void PartialFolder::finish() {
  // a folder renamed onto an empty one would take its place without a word
  require_free(folder_, "has appeared meanwhile, expected a name that is free");
  std::error_code error;
  std::filesystem::rename(partial_, folder_, error);
  if (error) throw InputError(folder_.string() + ": cannot be written: " + error.message());
  is_finished_ = true;
}

void write_each_frame(core::Source& source, const std::function<void(const core::Frame&)>& take) {
  core::Progress progress("frames", source.info().num_frames);
  int num_done = 0;
  while (const std::optional<core::Frame> frame = source.next()) {
    take(*frame);
    progress.update(++num_done);
    core::stop_if_interrupted();
  }
}

void write_tables(const PartialFolder& out, const std::vector<double>& stamps_s,
                  const SideTables& tables) {
  const WalkTruth& truth = tables.truth;
  core::require(truth.frames.size() == stamps_s.size(), "there is one row of truth per frame");
  out.write("frames.csv", frames_csv(truth.frames, stamps_s));
  out.write("loops.csv", loops_csv(truth.loops));
  out.write("aliased_pairs.csv", aliased_pairs_csv(truth.aliased_pairs));
  if (!truth.overlap.empty()) out.write("overlap.pgm", pgm(truth.overlap, stamps_s.size(), 255));
  if (!tables.wheels.empty()) out.write("wheels.csv", wheels_csv(tables.wheels));
}

void write_places(const PartialFolder& out, std::size_t num_frames,
                  const core::PlaceTruthMatrix& places) {
  out.write("same_place.pgm", pgm(places.values, num_frames, 2));
}

}  // namespace samewhere::twin
