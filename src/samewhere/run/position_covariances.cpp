#include <samewhere/pipeline/map_context.hpp>
#include <samewhere/run/position_covariances.hpp>
#include <samewhere/verify/drift_path.hpp>

namespace samewhere::run {

std::vector<report::PositionCovariance> position_covariances(const scene::MapVersion& map,
                                                             std::uint16_t session,
                                                             const pipeline::Config& config,
                                                             std::size_t max_num) {
  std::vector<const scene::Keyframe*> keyframes;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const scene::Keyframe& keyframe = map.keyframes[i];
    if (keyframe.view.frame.session() == session) keyframes.push_back(&keyframe);
  }
  std::vector<report::PositionCovariance> covariances;
  if (keyframes.empty()) return covariances;
  const core::KeyframeId first = keyframes.front()->id;
  const Eigen::Matrix3d world_from_first =
      scene::world_from_body(map, first).rotation.toRotationMatrix();
  verify::OdometryTree odometry = pipeline::odometry_tree(config);
  verify::DriftPaths paths(map, odometry);
  const std::size_t step = (keyframes.size() - 1) / max_num + 1;
  for (std::size_t i = step; i < keyframes.size(); i += step) {
    const auto in_first = paths.covariance(first, keyframes[i]->id);
    if (!in_first) continue;
    covariances.push_back(
        {keyframes[i]->view.frame,
         world_from_first * in_first->topLeftCorner<3, 3>() * world_from_first.transpose()});
  }
  return covariances;
}

}  // namespace samewhere::run
