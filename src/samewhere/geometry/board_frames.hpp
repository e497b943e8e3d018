#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>

namespace samewhere::geometry {

// Which frames of a video a calibration takes: sharp ones that show the board in places apart.

// How sharp a picture is: the variance of its Laplacian. Compares pictures of one camera.
double sharpness(const cv::Mat& image);

// The sharpest frame of each stretch of time.
class SharpestFrames {
 public:
  struct Frame {
    cv::Mat image;
    std::string name;
  };

  explicit SharpestFrames(double stretch_s) : stretch_s_(stretch_s) {}

  // Takes the next frame; gives the sharpest one of a stretch that has ended.
  std::optional<Frame> add(Frame frame, double stamp_s);
  // That of the last stretch, if any.
  std::optional<Frame> finish();

 private:
  double stretch_s_;
  std::optional<Frame> best_;
  double best_sharpness_ = 0.0;
  double begin_s_ = 0.0;
};

// At most `max_views` of the views, each of as many corners, ascending: one by one that whose
// corners lie farthest from all taken so far, on average, as long as that is min_distance_px.
std::vector<std::size_t> spread_views(const std::vector<std::vector<cv::Point2f>>& views,
                                      std::size_t max_views, double min_distance_px);

}  // namespace samewhere::geometry
