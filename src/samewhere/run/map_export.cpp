#include <algorithm>
#include <iterator>
#include <set>
#include <string>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/kitti_file.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/correct/loop_corrector.hpp>
#include <samewhere/optimize/g2o_file.hpp>
#include <samewhere/pipeline/slam.hpp>
#include <samewhere/report/ply.hpp>
#include <samewhere/run/map_export.hpp>

namespace samewhere::run {

std::vector<report::ColouredPoint> points_of(const scene::MapVersion& map) {
  std::vector<report::ColouredPoint> points;
  for (std::size_t i = 0; i < map.landmarks.size(); ++i) {
    const scene::Landmark& landmark = map.landmarks[i];
    if (!is_live(landmark)) continue;
    points.push_back({position_in_world(map, landmark).cast<float>(), landmark.rgb});
  }
  return points;
}

std::vector<report::Figure> figures_of_map(const scene::MapHeader& header,
                                           const scene::StoredMap& stored) {
  const auto& [map, extras] = stored;
  std::set<std::uint16_t> sessions;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i)
    sessions.insert(map.keyframes[i].view.frame.session());
  for (const core::FramePose& frame : extras.frames) sessions.insert(frame.frame.session());
  const auto num_measured =
      std::count_if(extras.frames.begin(), extras.frames.end(), core::is_confirmed);
  std::vector<report::Figure> figures = {
      {"sessions", std::to_string(sessions.size())},
      {"keyframes / landmarks",
       fmt::format("{} / {}", num_live(map.keyframes), num_live(map.landmarks))},
      {"frames, with a measured pose", fmt::format("{}, {}", extras.frames.size(), num_measured)},
      {"loop candidates / loop closures",
       fmt::format("{} / {}", extras.ledger.size(), map.loops.size())}};
  for (const auto& [name, value] : header) figures.push_back({name, value});
  return figures;
}

int session_of(const scene::StoredMap& stored, int wanted) {
  const std::vector<core::FramePose>& all = stored.extras.frames;
  if (all.empty()) return std::max(wanted, 0);
  const int last = all.back().frame.session();
  if (wanted <= last && (wanted >= 0 || last == 0)) return std::max(wanted, 0);
  throw core::InputError(
      fmt::format("--session = {}: the map holds frames of {} sessions, each with its own stamps; "
                  "expected one of 0 to {}",
                  wanted < 0 ? "none" : std::to_string(wanted), last + 1, last));
}

namespace {

// Of one session: stamps of different sessions may be equal.
std::vector<core::FramePose> frames_of(const scene::StoredMap& stored, int session) {
  std::vector<core::FramePose> frames;
  std::copy_if(stored.extras.frames.begin(), stored.extras.frames.end(), std::back_inserter(frames),
               [&](const auto& frame) { return frame.frame.session() == session; });
  return frames;
}

// Keyframes are numbered anew without those that were culled, so that odometry leads from a number
// to the next: that is how readers tell it from loops.
std::string g2o_of(const scene::MapVersion& map) {
  std::vector<long> names(map.keyframes.size(), -1);
  long num_live = 0;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i)
    if (is_live(map.keyframes[i])) names[i] = num_live++;
  return optimize::g2o_text(correct::pose_graph_of(map, {}), names);
}

// Before the first is written, so that none is left alone.
void check_files(const MapExports& wanted) {
  std::set<std::filesystem::path> files;
  for (const auto& file : {wanted.ply, wanted.tum, wanted.kitti, wanted.g2o}) {
    if (file.empty()) continue;
    const auto [known, is_new] = files.insert(std::filesystem::absolute(file).lexically_normal());
    if (!is_new)
      throw core::InputError(file.string() + ": named twice; expected a file for each format");
    core::make_writable_folder(known->parent_path());
  }
  if (files.empty())
    throw core::InputError("nothing to write; expected --ply, --tum, --kitti or --g2o");
}

}  // namespace

void export_map(const scene::StoredMap& stored, const MapExports& wanted) {
  check_files(wanted);
  if (!wanted.ply.empty()) core::write_file(wanted.ply, report::ply_bytes(points_of(stored.map)));
  if (!wanted.tum.empty() || !wanted.kitti.empty()) {
    const core::Trajectory trajectory =
        pipeline::trajectory_of(stored.map, frames_of(stored, session_of(stored, wanted.session)));
    if (!wanted.tum.empty()) core::write_file(wanted.tum, core::tum_text(trajectory));
    if (!wanted.kitti.empty()) core::write_file(wanted.kitti, core::kitti_text(trajectory));
  }
  if (!wanted.g2o.empty()) core::write_file(wanted.g2o, g2o_of(stored.map));
}

}  // namespace samewhere::run
