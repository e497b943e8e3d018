#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include <samewhere/core/frame.hpp>

namespace samewhere::bench {

// Where a picture was taken and how far things are in it.
struct ViewGeometry {
  core::Rigid3 world_from_camera;
  core::Camera camera;
  cv::Mat depth_m;                                // every kDepthStep_px-th pixel along both axes
  std::vector<Eigen::Vector3d> points_in_camera;  // where there is depth, more coarsely still
  double median_depth_m = 0.0;                    // 0: no depth at all
};

inline constexpr int kDepthStep_px = 4;

// `frame` has a calibrated camera and depth (else ContractError).
ViewGeometry view_geometry(const core::Frame& frame, const core::Rigid3& world_from_camera);

// What two views have in common.
struct SharedView {
  double overlap = 0.0;       // share of what `first` sees that `second` sees too
  double parallax_deg = 0.0;  // of that, median angle between the two directions it is seen from
};

// Seen by both: the depths agree within 5 cm + 4 % (protocol pr-v2). A point that falls where the
// second depth is unknown does not count.
SharedView shared_view(const ViewGeometry& first, const ViewGeometry& second);

// Limits of the classes of pairs: distance of the camera centres over the median depth (mean of
// both), and angle between the optical axes.
inline constexpr std::array<double, 6> kBaselineRatios = {0.0, 0.05, 0.1, 0.2, 0.4, 0.8};
inline constexpr std::array<double, 6> kAngles_deg = {0.0, 5.0, 10.0, 20.0, 30.0, 45.0};
inline constexpr int kNumClasses = 25;

// Which way the baseline runs: within 45 degrees of the mean of the two optical axes, or aside. At
// the same length a camera that goes forward changes its view of what is ahead far less.
enum class Way : std::uint8_t { kAny, kSideways, kForward };
inline constexpr std::array<Way, 3> kWays = {Way::kAny, Way::kSideways, Way::kForward};

bool goes(Way way, const ViewGeometry& first, const ViewGeometry& second);

// Class 5 * baseline + angle of a pair, or -1 outside all limits.
int pair_class(const ViewGeometry& first, const ViewGeometry& second);
// "t .05-.1, 5-10 deg"
std::string class_name(int pair_class);

struct ViewPair {
  int first = 0;
  int second = 0;
  double overlap = 0.0;       // the smaller of both ways
  double parallax_deg = 0.0;  // the mean of both ways
};

// Of each class at most max_pairs that go this way, drawn with a fixed seed among those that
// overlap by at least 0.3 both ways; fewer where the class has no more or 20 * max_pairs draws did
// not find them.
std::array<std::vector<ViewPair>, kNumClasses> draw_pairs(const std::vector<ViewGeometry>& views,
                                                          Way way, int max_pairs);

}  // namespace samewhere::bench
