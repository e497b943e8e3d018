#include <algorithm>
#include <set>

#include <fmt/format.h>

#include <samewhere/core/file.hpp>
#include <samewhere/core/kitti_file.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/correct/loop_corrector.hpp>
#include <samewhere/optimize/g2o_file.hpp>
#include <samewhere/pipeline/map_export.hpp>
#include <samewhere/pipeline/slam.hpp>
#include <samewhere/report/ply.hpp>

namespace samewhere::pipeline {

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
  const auto num_measured = std::count_if(extras.frames.begin(), extras.frames.end(),
                                          [](const core::FramePose& f) { return f.is_measured; });
  std::vector<report::Figure> figures = {
      {"sessions", std::to_string(sessions.size())},
      {"keyframes / landmarks",
       fmt::format("{} / {}", num_live(map.keyframes), num_live(map.landmarks))},
      {"frames, of these with a measured pose",
       fmt::format("{}, {}", extras.frames.size(), num_measured)},
      {"candidates judged / loops closed",
       fmt::format("{} / {}", extras.ledger.size(), map.loops.size())}};
  for (const auto& [name, value] : header) figures.push_back({name, value});
  return figures;
}

void export_map(const scene::StoredMap& stored, const MapExports& wanted) {
  if (!wanted.ply.empty()) core::write_file(wanted.ply, report::ply_bytes(points_of(stored.map)));
  const core::Trajectory trajectory = trajectory_of(stored.map, stored.extras.frames);
  if (!wanted.tum.empty()) core::write_file(wanted.tum, core::tum_text(trajectory));
  if (!wanted.kitti.empty()) core::write_file(wanted.kitti, core::kitti_text(trajectory));
  if (!wanted.g2o.empty())
    core::write_file(wanted.g2o, optimize::g2o_text(correct::pose_graph_of(stored.map, {})));
}

}  // namespace samewhere::pipeline
