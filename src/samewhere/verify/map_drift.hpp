#pragma once

#include <samewhere/scene/map_version.hpp>
#include <samewhere/verify/config.hpp>
#include <samewhere/verify/drift_path.hpp>
#include <samewhere/verify/odometry_tree.hpp>

namespace samewhere::verify {

// Of a camera without depth: standard deviations of the logarithm of its scale.
struct ScaleErrors {
  double creep = 0.01;  // from one keyframe to the next, at random
  double loop = 0.05;   // as a loop measures it
};

// A map version and how sure it is of its poses: by odometry alone, and with its loops. What claims
// of loops are held against. Not copyable: refers to map, tree and configuration, which outlive it.
class MapDrift {
 public:
  // `odometry` follows the map from here on.
  MapDrift(const scene::MapVersion& map, OdometryTree& odometry, const ScaleErrors& scale,
           const Config& config)
      : map_(map), odometry_(odometry), scale_(scale), config_(config), paths_(map, odometry) {}
  MapDrift(const MapDrift&) = delete;
  MapDrift& operator=(const MapDrift&) = delete;

  const scene::MapVersion& map() const { return map_; }
  const ScaleErrors& scale() const { return scale_; }
  const Config& config() const { return config_; }
  OdometryTree& odometry() { return odometry_; }
  DriftPaths& paths() { return paths_; }

 private:
  const scene::MapVersion& map_;
  OdometryTree& odometry_;
  ScaleErrors scale_;
  const Config& config_;
  DriftPaths paths_;
};

}  // namespace samewhere::verify
