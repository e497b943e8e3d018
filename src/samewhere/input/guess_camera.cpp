#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/geometry/camera_check.hpp>
#include <samewhere/input/guess_camera.hpp>

namespace samewhere::input {
namespace {

// Focal length that shows `side_px` under an angle.
double focal_px(double side_px, double view_deg) {
  return 0.5 * side_px / std::tan(0.5 * view_deg * std::numbers::pi / 180.0);
}

// What passes everything on.
class Wrapper : public core::Source {
 public:
  explicit Wrapper(std::unique_ptr<core::Source> source) : source_(std::move(source)) {}
  core::SourceInfo info() const override { return source_->info(); }
  core::Truth truth() const override { return source_->truth(); }
  core::Trajectory true_trajectory() const override { return source_->true_trajectory(); }
  std::optional<core::Frame> next() override { return source_->next(); }

 private:
  std::unique_ptr<core::Source> source_;
};

class PeekedSource : public Wrapper {
 public:
  PeekedSource(std::unique_ptr<core::Source> source, std::optional<core::Frame> first)
      : Wrapper(std::move(source)), first_(std::move(first)) {}
  std::optional<core::Frame> next() override {
    return first_ ? std::exchange(first_, std::nullopt) : Wrapper::next();
  }

 private:
  std::optional<core::Frame> first_;
};

class CalibratedSource : public Wrapper {
 public:
  CalibratedSource(std::unique_ptr<core::Source> source, const core::PinholeRadtan& camera)
      : Wrapper(std::move(source)), camera_(camera) {}

  core::SourceInfo info() const override {
    core::SourceInfo info = Wrapper::info();
    info.is_calibrated = true;
    return info;
  }
  std::optional<core::Frame> next() override {
    std::optional<core::Frame> frame = Wrapper::next();
    if (!frame) return frame;
    if (!rig_) {
      core::Rig rig = *frame->rig;
      rig.cameras = {camera_};
      rig.body_from_camera = {core::Rigid3{}};
      rig_ = std::make_shared<const core::Rig>(std::move(rig));
    }
    frame->rig = rig_;
    return frame;
  }

 private:
  core::PinholeRadtan camera_;
  std::shared_ptr<const core::Rig> rig_;
};

}  // namespace

GuessedCamera guess_camera(const cv::Size& size_px, double fov_deg, std::optional<double> film_mm) {
  constexpr double kFilmDiagonal_mm = 43.267;  // of 36 x 24 mm
  const double longer_px = std::max(size_px.width, size_px.height);
  GuessedCamera guess;
  double f_px = focal_px(longer_px, kGuessedView_deg);
  guess.reason = fmt::format(
      "a field of view of {} degrees along the longer side, as most cameras "
      "have",
      kGuessedView_deg);
  if (fov_deg > 0.0) {
    f_px = focal_px(size_px.width, fov_deg);
    guess.reason = fmt::format("a horizontal field of view of {} degrees, as given", fov_deg);
  } else if (film_mm) {
    f_px = std::hypot(size_px.width, size_px.height) * *film_mm / kFilmDiagonal_mm;
    guess.reason = fmt::format("the pictures' EXIF data, {} mm in 35 mm film", *film_mm);
  }
  guess.camera = {.width_px = size_px.width,
                  .height_px = size_px.height,
                  .fx_px = f_px,
                  .fy_px = f_px,
                  .cx_px = 0.5 * (size_px.width - 1.0),
                  .cy_px = 0.5 * (size_px.height - 1.0)};
  if (const auto fault = geometry::fault_of(guess.camera)) {
    throw core::InputError(fmt::format("from {}: {}", guess.reason, *fault));
  }
  return guess;
}

Peeked peek(std::unique_ptr<core::Source> source) {
  std::optional<core::Frame> first = source->next();
  return {std::make_unique<PeekedSource>(std::move(source), first), first};
}

std::unique_ptr<core::Source> with_camera(std::unique_ptr<core::Source> source,
                                          const core::PinholeRadtan& camera) {
  return std::make_unique<CalibratedSource>(std::move(source), camera);
}

}  // namespace samewhere::input
