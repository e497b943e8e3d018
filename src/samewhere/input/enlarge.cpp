#include <cmath>
#include <optional>
#include <utility>
#include <variant>

#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/enlarge.hpp>

namespace samewhere::input {
namespace {

using core::PinholeRadtan;

// The centre of the upper left pixel is (0, 0), so its outer corner is (-0.5, -0.5) in both.
double enlarged_px(double pixel, double factor) { return (pixel + 0.5) * factor - 0.5; }

PinholeRadtan enlarged_camera(PinholeRadtan camera, const cv::Size& taken_px,
                              const cv::Size& size_px) {
  const double factor_x = static_cast<double>(size_px.width) / taken_px.width;
  const double factor_y = static_cast<double>(size_px.height) / taken_px.height;
  camera.fx_px *= factor_x;
  camera.fy_px *= factor_y;
  camera.cx_px = enlarged_px(camera.cx_px, factor_x);
  camera.cy_px = enlarged_px(camera.cy_px, factor_y);
  if (camera.width_px > 0) camera.width_px = size_px.width;
  if (camera.height_px > 0) camera.height_px = size_px.height;
  return camera;
}

class EnlargedSource : public core::Source {
 public:
  explicit EnlargedSource(std::unique_ptr<core::Source> source) : source_(std::move(source)) {}

  core::SourceInfo info() const override { return source_->info(); }
  core::Truth truth() const override { return source_->truth(); }
  core::Trajectory true_trajectory() const override { return source_->true_trajectory(); }

  std::optional<core::Frame> next() override {
    std::optional<core::Frame> frame = source_->next();
    if (!frame || frame->images.empty() || !frame->rig->is_calibrated()) return frame;
    if (frame->id.index() == 0) prepare_for(*frame);
    if (rig_ == nullptr) return frame;
    for (auto& image : frame->images) image = enlarged_picture(image, cv::INTER_LINEAR);
    if (frame->depth_m) frame->depth_m = enlarged_picture(*frame->depth_m, cv::INTER_NEAREST);
    frame->rig = rig_;
    return frame;
  }

 private:
  void prepare_for(const core::Frame& frame) {
    const cv::Size taken_px = frame.images.front().size();
    const double factor = enlargement_of(taken_px);
    if (factor <= 1.0) return;
    size_px_ = {static_cast<int>(std::lround(taken_px.width * factor)),
                static_cast<int>(std::lround(taken_px.height * factor))};
    core::Rig rig = *frame.rig;
    for (auto& camera : rig.cameras) {
      core::require(std::holds_alternative<PinholeRadtan>(camera),
                    "pictures are straightened before they are enlarged");
      camera = enlarged_camera(std::get<PinholeRadtan>(camera), taken_px, size_px_);
    }
    rig_ = std::make_shared<const core::Rig>(std::move(rig));
  }

  cv::Mat enlarged_picture(const cv::Mat& taken, int interpolation) const {
    cv::Mat picture;
    cv::resize(taken, picture, size_px_, 0.0, 0.0, interpolation);
    return picture;
  }

  std::unique_ptr<core::Source> source_;
  // all frames have the rig, and the size, of the first
  std::shared_ptr<const core::Rig> rig_;  // none: pictures pass as they are
  cv::Size size_px_;
};

}  // namespace

double enlargement_of(const cv::Size& size_px) {
  constexpr double kUsualArea_px = 640.0 * 480.0;
  constexpr double kSmallArea_px = 480.0 * 360.0;
  const double area_px = static_cast<double>(size_px.width) * size_px.height;
  return area_px > 0.0 && area_px < kSmallArea_px ? std::sqrt(kUsualArea_px / area_px) : 1.0;
}

std::unique_ptr<core::Source> enlarged(std::unique_ptr<core::Source> source) {
  core::require(source != nullptr, "there is a source to enlarge");
  return std::make_unique<EnlargedSource>(std::move(source));
}

}  // namespace samewhere::input
