#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <samewhere/core/frame_pose.hpp>
#include <samewhere/core/ids.hpp>
#include <samewhere/core/ledger.hpp>
#include <samewhere/core/rigid3.hpp>
#include <samewhere/core/timing.hpp>
#include <samewhere/core/truth.hpp>

namespace samewhere::report {

struct FrameRecord {
  core::FramePose pose;
  std::string name;  // how the source calls it
  // Of camera 0, after all corrections; nothing if the pose was not measured.
  std::optional<core::Rigid3> world_from_camera;
};

struct ColouredPoint {
  Eigen::Vector3f in_world = Eigen::Vector3f::Zero();
  std::array<std::uint8_t, 3> rgb{};
};

// One measured figure as it is shown to a person.
struct Figure {
  std::string name;                  // "ATE RMSE"
  std::string value;                 // "0.021 m"
  std::vector<double> numbers = {};  // in it, unrounded, in their order (figure.hpp)
};

// A finished run, as plain data.
struct RunRecord {
  std::string title;
  std::string source;               // what the user asked for: a folder, a file, twin:...
  std::vector<FrameRecord> frames;  // in the order of the source
  core::Ledger ledger;
  core::Trajectory odometry;          // before any correction; may be empty
  core::Trajectory truth;             // aligned into the world of the estimate; may be empty
  std::vector<ColouredPoint> points;  // of the map
  std::map<core::FrameId, std::string>
      thumbnails;  // JPEG (jpeg.hpp), of frames the ledger speaks of
  std::vector<Figure> figures;
  core::Timings timings;  // stage kWholeFrameStage is what frames per second are counted by
  // Of the whole program, when the last frame was done; nothing where frames come at a pace of
  // their own, or several at once.
  std::optional<double> processor_ms;
  std::string config_yaml;
  std::optional<double> first_pose_s;  // from the program's start to the first measured pose
  bool is_scale_unknown = false;       // one camera without depth: lengths are in map units
  bool is_interrupted = false;
  std::optional<std::string> input_error;  // the source broke: what came after is missing
};

// The name under which the pipeline times all work on one frame.
inline constexpr const char* kWholeFrameStage = "frame";
inline constexpr const char* kWaitForInputStage = "wait for input";

}  // namespace samewhere::report
