#pragma once

#include <optional>
#include <string>
#include <vector>

#include <samewhere/event.hpp>
#include <samewhere/map.hpp>
#include <samewhere/messages/messages.hpp>
#include <samewhere/slam.hpp>

// What a node tells, as messages.

namespace samewhere::node {

messages::Header header_of(const std::string& frame, double stamp_s);

// The pose of the base in the map. `covariance` is that of the body relative to its reference
// keyframe, in axes of the body: they are turned into those of the map, which ROS expects, by
// `map_from_body`, as if the keyframe had the body's axes.
messages::PoseWithCovarianceStamped pose_message(const messages::Header& header,
                                                 const Pose& map_from_base,
                                                 const Eigen::Matrix3d& map_from_body,
                                                 const std::optional<Covariance>& covariance);

// The base at each keyframe, after all corrections so far.
messages::Path path_message(const messages::Header& header, const Map& map,
                            const Pose& camera_from_base);

// Points x y z (float, metres) with rgb; of more than `most` every n-th.
messages::PointCloud2 landmarks_message(const messages::Header& header, const Map& map,
                                        std::size_t most);

// A loop verdict with its reason and scores; a step of relocalization; a correction of the map.
// Nothing of a keyframe.
std::optional<messages::DiagnosticStatus> event_message(const Event& event);

// "initializing", "tracking", "weak", "lost", "provisional".
std::string status_name(Status status);

}  // namespace samewhere::node
