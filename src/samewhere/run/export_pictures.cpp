#include <cmath>
#include <cstdint>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/input/straighten.hpp>
#include <samewhere/run/export_model.hpp>
#include <samewhere/run/export_pictures.hpp>
#include <samewhere/run/source_frames.hpp>
#include <samewhere/twin/render/picture_file.hpp>

namespace samewhere::run {
namespace {

// 0: unknown, or more than 16 bits hold.
cv::Mat in_millimetres(const cv::Mat& depth_m) {
  constexpr float kMillimetresPerMetre = 1000.0F;
  constexpr float kMost_mm = 65535.0F;
  cv::Mat depth_mm(depth_m.size(), CV_16UC1, cv::Scalar(0));
  for (int y = 0; y < depth_m.rows; ++y) {
    for (int x = 0; x < depth_m.cols; ++x) {
      const float value_mm = std::round(depth_m.at<float>(y, x) * kMillimetresPerMetre);
      if (value_mm > 0.0F && value_mm <= kMost_mm)
        depth_mm.at<std::uint16_t>(y, x) = static_cast<std::uint16_t>(value_mm);
    }
  }
  return depth_mm;
}

// Writes the frames that are keyframes, one after the other.
class PictureWriter {
 public:
  explicit PictureWriter(const PicturePlan& plan) : plan_(plan) {}

  void write(const core::Frame& frame, const scene::Keyframe& keyframe) {
    const cv::Mat& picture = frame.images.front();
    if (written_.has_depth.empty()) prepare(picture.size(), keyframe.view);
    if (picture.size() != written_.size_px)
      throw core::InputError(fmt::format(
          "{}: has {} x {} pixels, the pictures before it {} x {}; expected one size", frame.name,
          picture.cols, picture.rows, written_.size_px.width, written_.size_px.height));
    const std::string name = picture_name(frame.id);
    core::write_file(plan_.images / name, twin::png_bytes(undistorted(picture, cv::INTER_LINEAR)));
    const bool has_depth = frame.depth_m && !plan_.depth.empty();
    written_.has_depth.push_back(has_depth);
    if (has_depth) write_depth(*frame.depth_m, name);
  }

  WrittenPictures take() { return std::move(written_); }

 private:
  void prepare(const cv::Size& size_px, const features::View& view) {
    written_.size_px = size_px;
    const core::PinholeRadtan taken = camera_of_pictures(view, {size_px, false});
    const core::PinholeRadtan ideal = camera_of_pictures(view, {size_px, true});
    if (plan_.is_undistorted && has_distortion(taken))
      map_ = input::pixel_map(taken, ideal, cv::Matx33d::eye());
    if (plan_.begin) plan_.begin();
    core::make_writable_folder(plan_.images);
  }

  cv::Mat undistorted(const cv::Mat& taken, int interpolation) const {
    return map_ ? map_->apply(taken, interpolation) : taken;
  }

  void write_depth(const cv::Mat& depth_m, const std::string& name) {
    core::make_writable_folder(plan_.depth);
    // between two surfaces there is no depth to interpolate
    core::write_file(plan_.depth / name,
                     twin::png_bytes(in_millimetres(undistorted(depth_m, cv::INTER_NEAREST))));
  }

  const PicturePlan& plan_;
  WrittenPictures written_;
  std::optional<input::PixelMap> map_;  // none: pictures stay as they are
};

// Stamps of the same frame are equal up to how a source reads them.
void require_same_frame(const core::Frame& frame, const scene::Keyframe& keyframe,
                        const pipeline::Config& config) {
  constexpr double kStampTolerance_s = 1e-5;
  if (std::abs(frame.stamp_s - keyframe.view.stamp_s) <= kStampTolerance_s) return;
  throw core::InputError(fmt::format(
      "{}: frame {} has the stamp {:.6f} s, the keyframe of the run {:.6f} s: the source has "
      "changed since the run, or the run dropped frames (--realtime)",
      config.source, frame.id.index(), frame.stamp_s, keyframe.view.stamp_s));
}

}  // namespace

std::string picture_name(core::FrameId frame) {
  return fmt::format("frame-{:06}.png", frame.index());
}

WrittenPictures write_pictures(const std::vector<const scene::Keyframe*>& keyframes,
                               const pipeline::Config& config, const PicturePlan& plan) {
  std::set<std::uint64_t> positions;
  for (const scene::Keyframe* keyframe : keyframes) positions.insert(keyframe->view.frame.index());
  SourceFrames frames(config, positions);
  PictureWriter writer(plan);
  for (const scene::Keyframe* keyframe : keyframes) {
    const std::optional<core::Frame> frame = frames.next();
    core::require(frame.has_value(), "each keyframe is a frame of its own");
    require_same_frame(*frame, *keyframe, config);
    writer.write(*frame, *keyframe);
  }
  return writer.take();
}

}  // namespace samewhere::run
