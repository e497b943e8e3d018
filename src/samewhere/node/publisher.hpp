#pragma once

#include <samewhere/messages/messages.hpp>

namespace samewhere::node {

// Where a node's messages go: a transport, a test. Called in the node's thread but
// where it says otherwise.
class Publisher {
 public:
  Publisher() = default;
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;
  virtual ~Publisher() = default;

  // With each frame: map -> odom, and odom -> base unless odometry comes from elsewhere.
  virtual void transforms(const messages::TFMessage& message) = 0;
  // Of the base in the map, with each frame whose pose is measured.
  virtual void pose(const messages::PoseWithCovarianceStamped& message) = 0;
  // Of the base at all keyframes, when the map has changed.
  virtual void path(const messages::Path& message) = 0;
  // When the map has changed.
  virtual void landmarks(const messages::PointCloud2& message) = 0;
  // The occupancy grid of the depth of the keyframes, when the map has changed. Called in another
  // thread.
  virtual void grid(const messages::OccupancyGrid& message) = 0;
  // Loop verdicts with their reasons and other events when they happen; the node's state in
  // between.
  virtual void diagnostics(const messages::DiagnosticArray& message) = 0;
  // One word (outputs.hpp), or what is waited for, when it changes.
  virtual void status(const messages::String& message) = 0;
};

}  // namespace samewhere::node
