#include <utility>

#include <Eigen/LU>

#include <samewhere/library/convert.hpp>
#include <samewhere/library/map_content.hpp>

namespace samewhere {
namespace library {

std::shared_ptr<const Map> snapshot(const scene::MapVersion& map, bool is_metric) {
  return std::make_shared<const Map>(
      std::make_shared<const Map::Content>(Map::Content{map, is_metric}));
}

Pose map_from_camera(const scene::MapVersion& map, const scene::Keyframe& keyframe) {
  return pose_of(world_from_body(map, keyframe.id) * keyframe.view.rig->body_from_told_camera());
}

}  // namespace library

Map::Map(std::shared_ptr<const Content> content) : content_(std::move(content)) {}

Map::~Map() = default;

std::uint64_t Map::version() const { return content_->map.number; }

std::size_t Map::num_keyframes() const { return content_->map.keyframes.size(); }

bool Map::is_metric() const { return content_->is_metric; }

std::vector<Map::Keyframe> Map::keyframes() const {
  const scene::MapVersion& map = content_->map;
  std::vector<Keyframe> keyframes;
  keyframes.reserve(map.keyframes.size());
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const scene::Keyframe& keyframe = map.keyframes[i];
    keyframes.push_back({.id = keyframe.id.value(),
                         .frame = library::key_of(keyframe.view.frame),
                         .stamp_s = keyframe.view.stamp_s,
                         .map_from_camera = library::map_from_camera(map, keyframe),
                         .is_culled = !is_live(keyframe)});
  }
  return keyframes;
}

std::vector<Map::Landmark> Map::landmarks() const {
  const scene::MapVersion& map = content_->map;
  std::vector<Landmark> landmarks;
  for (std::size_t i = 0; i < map.landmarks.size(); ++i) {
    const scene::Landmark& landmark = map.landmarks[i];
    if (!is_live(landmark)) continue;
    landmarks.push_back({.id = landmark.id.value(),
                         .in_map = position_in_world(map, landmark),
                         .rgb = landmark.rgb,
                         .num_observations = static_cast<int>(landmark.observations.size())});
  }
  return landmarks;
}

std::vector<Map::Edge> Map::odometry() const {
  const scene::MapVersion& map = content_->map;
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const scene::Keyframe& keyframe = map.keyframes[i];
    if (!keyframe.odometry) continue;
    edges.push_back({.from = keyframe.odometry->parent.value(),
                     .to = keyframe.id.value(),
                     .from_pose_to = library::pose_of(parent_from_keyframe(keyframe)),
                     .covariance = keyframe.odometry->information.inverse(),
                     .candidate = std::nullopt});
  }
  return edges;
}

std::vector<Map::Edge> Map::loops() const {
  std::vector<Edge> edges;
  for (const scene::LoopEdge& loop : content_->map.loops) {
    edges.push_back({.from = loop.match.value(),
                     .to = loop.query.value(),
                     .from_pose_to = library::pose_of(loop.match_from_query),
                     .covariance = loop.information.inverse(),
                     .candidate = loop.cause.value()});
  }
  return edges;
}

}  // namespace samewhere
