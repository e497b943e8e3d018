#include <utility>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/open.hpp>
#include <samewhere/library/border.hpp>
#include <samewhere/library/convert.hpp>
#include <samewhere/recording.hpp>
#include <samewhere/twin/front/twin.hpp>

namespace samewhere {
namespace {

Image view_of(const cv::Mat& image, PixelFormat format) {
  return {.data = image.data,
          .width_px = image.cols,
          .height_px = image.rows,
          .format = format,
          .stride_bytes = image.step};
}

}  // namespace

struct Recording::Content {
  std::unique_ptr<core::Source> source;
  std::optional<core::Frame> read_ahead;
  core::Frame newest;  // whose images the caller sees
};

Recording::Recording(const std::string& source, const std::vector<std::string>& settings)
    : content_(library::at_border([&] {
        const pipeline::Config config = library::config_of("default", settings, std::nullopt);
        auto content = std::make_unique<Content>();
        content->source = twin::is_twin_spec(source) ? twin::open_twin(source, config.twin)
                                                     : input::open_source(source, config.input);
        return content;
      })) {}

Recording::~Recording() = default;

Calibration Recording::calibration() {
  return library::at_border([&] {
    Content& content = *content_;
    if (!content.read_ahead) content.read_ahead = content.source->next();
    if (!content.read_ahead)
      throw core::InputError("the recording has no frame; expected one for its calibration");
    const core::Frame& frame = *content.read_ahead;
    if (!frame.rig->is_calibrated()) {
      throw core::InputError(
          "the recording has no camera file; expected one (setting input.camera)");
    }
    const core::SourceInfo info = content.source->info();
    Calibration calibration{.has_depth = info.has_depth, .frame_rate_hz = info.frame_rate_hz};
    for (std::size_t i = 0; i < frame.rig->cameras.size(); ++i) {
      calibration.cameras.push_back(
          library::camera_of(frame.rig->cameras[i], frame.images[i].cols, frame.images[i].rows));
      calibration.cameras.back().body_from_camera =
          library::pose_of(frame.rig->body_from_camera[i]);
    }
    return calibration;
  });
}

std::optional<Frame> Recording::next() {
  return library::at_border([&]() -> std::optional<Frame> {
    Content& content = *content_;
    std::optional<core::Frame> read = std::exchange(content.read_ahead, std::nullopt);
    if (!read) read = content.source->next();
    if (!read) return std::nullopt;
    content.newest = *std::move(read);
    Frame frame{.stamp_s = content.newest.stamp_s, .images = {}, .depth = {}};
    for (const cv::Mat& image : content.newest.images) {
      const bool is_grey = image.channels() == 1;
      frame.images.push_back(view_of(image, is_grey ? PixelFormat::kGray8 : PixelFormat::kBgr8));
    }
    if (content.newest.depth_m)
      frame.depth = view_of(*content.newest.depth_m, PixelFormat::kDepthFloat);
    return frame;
  });
}

}  // namespace samewhere
