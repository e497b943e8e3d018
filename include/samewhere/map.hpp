#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <samewhere/event.hpp>
#include <samewhere/types.hpp>

namespace samewhere {

// A map at one moment. Immutable: any thread may read it while tracking goes on. Taking a snapshot
// shares the map's memory; the lists below are made when they are asked for.
class Map {
 public:
  struct Keyframe {
    std::uint64_t id = 0;
    FrameKey frame;
    double stamp_s = 0.0;
    Pose map_from_camera = Pose::Identity();
    bool is_culled = false;  // no longer observes landmarks; its pose follows its neighbours
  };
  struct Landmark {
    std::uint64_t id = 0;
    Eigen::Vector3d in_map = Eigen::Vector3d::Zero();
    std::array<std::uint8_t, 3> rgb{};
    int num_observations = 0;
  };
  // An edge of the pose graph. Bodies of the two keyframes.
  struct Edge {
    std::uint64_t from = 0;
    std::uint64_t to = 0;
    Pose from_pose_to = Pose::Identity();  // body of `from` from body of `to`
    Covariance covariance = Covariance::Identity();
    std::optional<std::uint64_t> candidate;  // a loop: its candidate. None: odometry
  };

  struct Content;
  explicit Map(std::shared_ptr<const Content> content);
  ~Map();
  Map(const Map&) = delete;
  Map& operator=(const Map&) = delete;

  // Rises with every change; maps of one session with equal versions are equal.
  std::uint64_t version() const;
  std::size_t num_keyframes() const;  // with culled ones
  bool is_metric() const;             // lengths are metres

  std::vector<Keyframe> keyframes() const;  // ascending
  std::vector<Landmark> landmarks() const;
  std::vector<Edge> odometry() const;
  std::vector<Edge> loops() const;  // accepted and not withdrawn

 private:
  std::shared_ptr<const Content> content_;
};

}  // namespace samewhere
