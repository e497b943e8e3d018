#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <samewhere/event.hpp>
#include <samewhere/types.hpp>

namespace samewhere {

/// A map at one moment. Immutable: any thread may read it while tracking goes on. Taking a snapshot
/// shares the map's memory; the lists below are made when they are asked for.
class Map {
 public:
  /// A frame that is part of the map.
  struct Keyframe {
    std::uint64_t id = 0;                     ///< unique in the map
    FrameKey frame;                           ///< the frame that became this keyframe
    double stamp_s = 0.0;                     ///< of that frame, seconds
    Pose map_from_camera = Pose::Identity();  ///< camera 0 as it was given, before rectification
    bool is_culled = false;  ///< no longer observes landmarks; its pose follows its neighbours
  };
  /// A 3D point that keyframes observe.
  struct Landmark {
    std::uint64_t id = 0;                              ///< unique in the map
    Eigen::Vector3d in_map = Eigen::Vector3d::Zero();  ///< position, metres if is_metric()
    std::array<std::uint8_t, 3> rgb{};                 ///< red, green, blue of one observation
    int num_observations = 0;                          ///< keyframes that observe it
  };
  /// An edge of the pose graph: the relative pose of the bodies of two keyframes.
  struct Edge {
    std::uint64_t from = 0;                ///< id of a keyframe; of a loop the match
    std::uint64_t to = 0;                  ///< id of a keyframe; of a loop the query
    Pose from_pose_to = Pose::Identity();  ///< takes a point in the body of `to` to that of `from`
    Covariance covariance = Covariance::Identity();  ///< of from_pose_to, [m; rad]
    std::optional<std::uint64_t> candidate;  ///< of a loop LoopVerdict::candidate; empty: odometry
  };

  /// Not part of the interface.
  struct Content;
  /// Sessions make maps: Slam::map(), LoopCloser::map().
  explicit Map(std::shared_ptr<const Content> content);
  ~Map();
  Map(const Map&) = delete;
  Map& operator=(const Map&) = delete;

  /// Rises with every change; maps of one session with equal versions are equal.
  std::uint64_t version() const;
  /// Number of keyframes, with culled ones.
  std::size_t num_keyframes() const;
  /// Lengths are metres. False: one camera without depth, whose scale is unknown.
  bool is_metric() const;

  /// All keyframes, ascending by id.
  std::vector<Keyframe> keyframes() const;
  /// Landmarks that are not culled, ascending by id.
  std::vector<Landmark> landmarks() const;
  /// Odometry edges, from a keyframe's parent to the keyframe.
  std::vector<Edge> odometry() const;
  /// Loop closures that are accepted and not withdrawn.
  std::vector<Edge> loops() const;

 private:
  std::shared_ptr<const Content> content_;
};

}  // namespace samewhere
