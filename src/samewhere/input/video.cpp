#include <algorithm>
#include <array>
#include <cctype>
#include <string>

#include <dlfcn.h>
#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/camera_file.hpp>
#include <samewhere/input/video.hpp>
#include <samewhere/input/video_decoder.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using std::filesystem::path;

constexpr double kUnknownFps = 30.0;  // of a file or camera that does not say

// Never unloaded: FFmpeg leaves things behind that run at exit.
OpenVideo* load(const path& plugin) {
  void* const library = dlopen(plugin.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* const function = library == nullptr ? nullptr : dlsym(library, kOpenVideoSymbol);
  if (function != nullptr) return reinterpret_cast<OpenVideo*>(function);
  const char* const reason = dlerror();
  throw InputError(fmt::format(
      "{}: the plugin that reads videos and cameras cannot be loaded ({}); `./run build` makes it",
      plugin.string(), reason == nullptr ? "no reason given" : reason));
}

std::unique_ptr<VideoDecoder> open_decoder(const path& video, bool is_camera, const path& plugin) {
  std::unique_ptr<VideoDecoder> decoder(load(plugin)(video.c_str(), is_camera));
  if (decoder != nullptr) return decoder;
  throw InputError(video.string() + (is_camera ? ": cannot be opened as a camera; is it one, and "
                                                 "does no other program use it?"
                                               : ": cannot be read as a video"));
}

class VideoSource : public core::Source {
 public:
  VideoSource(const path& video, const Config& config, const path& plugin)
      : path_(video),
        fps_(config.fps),
        decoder_(open_decoder(video, is_camera_device(video), plugin)),
        waiting_(decoder_->next()) {
    if (waiting_.image.empty()) throw InputError(video.string() + ": gives no picture");
    size_px_ = waiting_.image.size();
    core::Rig rig;
    if (!config.camera.empty()) {
      rig.cameras = {read_camera_file_for(config.camera, size_px_, video)};
      rig.body_from_camera = {core::Rigid3{}};
    }
    rig_ = std::make_shared<const core::Rig>(rig);
    const bool is_live = is_camera_device(video);
    const double told_hz =
        decoder_->frame_rate_hz() > 0.0 ? decoder_->frame_rate_hz() : kUnknownFps;
    info_ = {.name = video.stem().string(),
             .format = is_live ? "camera" : "video",
             .num_frames = is_live ? 0 : std::max(decoder_->num_frames(), 0),
             .is_calibrated = rig_->is_calibrated(),
             .is_live = is_live,
             .frame_rate_hz = fps_ > 0.0 ? fps_ : told_hz};
  }

  core::SourceInfo info() const override { return info_; }
  core::Truth truth() const override { return {}; }

  std::optional<core::Frame> next() override {
    VideoPicture picture = num_given_ == 0 ? std::exchange(waiting_, {}) : decoder_->next();
    if (picture.image.empty()) return std::nullopt;
    core::Frame frame;
    frame.id = core::FrameId(num_given_);
    frame.stamp_s = stamp_s(picture);
    frame.name = fmt::format("{} picture {}", path_.filename().string(), num_given_);
    frame.rig = rig_;
    frame.images = {std::move(picture.image)};
    if (frame.images[0].size() != size_px_) {
      throw InputError(fmt::format(
          "{}: picture {} is {} x {} pixels, expected {} x {} as the first", path_.string(),
          num_given_, frame.images[0].cols, frame.images[0].rows, size_px_.width, size_px_.height));
    }
    last_stamp_s_ = frame.stamp_s;
    ++num_given_;
    return frame;
  }

 private:
  double stamp_s(const VideoPicture& picture) const {
    if (fps_ > 0.0) return static_cast<double>(num_given_) / fps_;
    if (num_given_ == 0 || picture.stamp_s > last_stamp_s_) return picture.stamp_s;
    return last_stamp_s_ + 1.0 / info_.frame_rate_hz;
  }

  path path_;
  double fps_ = 0.0;  // 0: the stamps are the decoder's
  std::unique_ptr<VideoDecoder> decoder_;
  VideoPicture waiting_;  // the first, which is read early for its size
  cv::Size size_px_;
  std::shared_ptr<const core::Rig> rig_;
  core::SourceInfo info_;
  std::uint64_t num_given_ = 0;
  double last_stamp_s_ = 0.0;
};

}  // namespace

bool is_video_name(std::string_view name) {
  std::string extension = path(name).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  constexpr std::array kExtensions = {".mp4", ".avi",  ".mkv",  ".mov", ".m4v",
                                      ".mpg", ".mpeg", ".webm", ".ogv"};
  return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

bool is_camera_device(const path& path) {
  std::error_code error;  // where we may not look there is none
  return std::filesystem::is_character_file(path, error);
}

path video_plugin_path() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / "samewhere-video.so";
}

std::unique_ptr<core::Source> open_video(const path& video, const Config& config,
                                         const path& plugin) {
  return std::make_unique<VideoSource>(video, config, plugin);
}

}  // namespace samewhere::input
