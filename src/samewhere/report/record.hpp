#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
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
  std::string name;  // of the source
  // Of camera 0, after all corrections; nothing if the pose was not measured.
  std::optional<core::Rigid3> world_from_camera;
};

struct ColouredPoint {
  Eigen::Vector3f in_world = Eigen::Vector3f::Zero();
  std::array<std::uint8_t, 3> rgb{};
};

// One metric as it is printed.
struct Figure {
  std::string name;                  // "ATE RMSE"
  std::string value;                 // "0.021 m"
  std::vector<double> numbers = {};  // unrounded, in the order of the text (figure.hpp)
};

// A feature match of a candidate, as shares of the width and height of either image.
struct ImageMatch {
  Eigen::Vector2f in_query = Eigen::Vector2f::Zero();
  Eigen::Vector2f in_match = Eigen::Vector2f::Zero();
  bool is_inlier = false;  // the candidate's relative pose explains it
};

// How uncertain the position of a keyframe is, relative to the first one of the run.
struct PositionCovariance {
  core::FrameId frame;
  Eigen::Matrix3d in_world_m2 = Eigen::Matrix3d::Zero();
};

// Resident memory of the program at a frame.
struct MemorySample {
  int frame = 0;  // 0-based position in the source
  double mib = 0.0;
};

// The threshold of a score of loops.json.
struct ScoreLimit {
  std::string score;        // "num_inliers"
  std::string setting;      // "verify.min_inliers"
  bool is_minimum = false;  // else the largest that passes
  double value = 0.0;
  std::string share_of = {};  // of which other score it is a share; empty: of none
};

// A finished run, as plain data.
struct RunRecord {
  std::string title;
  std::string source;               // what the user asked for: a folder, a file, twin:...
  std::vector<FrameRecord> frames;  // in the order of the source
  core::Ledger ledger;
  std::set<core::CandidateId> false_loops;  // accepted, and the ground truth contradicts them
  core::Trajectory odometry;                // before any correction; may be empty
  core::Trajectory truth;                   // aligned into the world of the estimate; may be empty
  std::vector<ColouredPoint> points;        // of the map
  std::map<core::FrameId, std::string> thumbnails;  // JPEG (jpeg.hpp), of keyframes; in recognition
                                                    // alone, of the frames in the ledger
  std::map<core::CandidateId, std::vector<ImageMatch>> matches;  // of some candidates
  std::vector<ScoreLimit> limits;                                // in the order of the checks
  std::vector<PositionCovariance> covariances;  // of some keyframes; empty if the scale is unknown
  std::vector<Figure> figures;
  core::Timings timings;             // stage kWholeFrameStage gives the frames per second
  std::vector<MemorySample> memory;  // in the order of the frames
  // CPU time of the whole program after the last frame; nothing for live sources and where several
  // frames are processed at once.
  std::optional<double> processor_ms;
  std::string config_yaml;
  std::optional<double> first_pose_s;  // from program start to the first measured pose
  bool is_scale_unknown = false;       // one camera without depth: poses are in map units
  bool is_interrupted = false;
  std::optional<std::string> input_error;  // the source failed; later frames are missing
};

// The name under which the pipeline times all work on one frame.
inline constexpr const char* kWholeFrameStage = "frame";
inline constexpr const char* kWaitForInputStage = "wait for input";

}  // namespace samewhere::report
