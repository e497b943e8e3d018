#include <algorithm>
#include <array>
#include <cctype>
#include <string>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file_kind.hpp>
#include <samewhere/input/camera_file.hpp>
#include <samewhere/input/file_names.hpp>
#include <samewhere/input/truth_file.hpp>
#include <samewhere/input/video.hpp>
#include <samewhere/input/video_decoder.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using std::filesystem::path;

constexpr double kUnknownFps = 30.0;  // of a file or camera that does not say

// A video as its container tells it.
struct Claim {
  int num_frames = 0;  // 0: it does not say
  double rate_hz = kUnknownFps;
};

// Asked when the decoder gives no more pictures: is that the end that was claimed? Counts are not
// exact. MP4 and AVI list every picture, those too that an edit list hides or that were dropped;
// Matroska tells a length only, of the longest track, which times a nominal rate is too many where
// the rate varied. So a video is cut short if pictures and time are missing: two pictures or 5 % of
// it, at most a second, is usual. Of such a video is used what was there.
void check_end(const path& video, const Claim& claim, std::uint64_t num_read, double lasted_s) {
  constexpr double kUsualRatio = 0.05;
  constexpr double kMaxUsual_s = 1.0;
  constexpr double kUsualFrames = 2.0;
  const double num_missing = claim.num_frames - static_cast<double>(num_read);
  if (num_missing <= kUsualFrames) return;
  const double claimed_s = claim.num_frames / claim.rate_hz;
  const double usual_s =
      std::max(std::min(kUsualRatio * claimed_s, kMaxUsual_s), kUsualFrames / claim.rate_hz);
  if (lasted_s < claimed_s - usual_s) {
    spdlog::warn(
        "{}: ends after {} pictures ({:.1f} s), expected {} ({:.1f} s) as the file says: it is cut "
        "short or damaged",
        video.string(), num_read, lasted_s, claim.num_frames, claimed_s);
    return;
  }
  if (num_missing <= kUsualRatio * claim.num_frames) return;
  spdlog::warn("{}: has {} of the {} pictures it claims: its rate varies, or it is damaged",
               video.string(), num_read, claim.num_frames);
}

// The camera of a video: that of input.camera, or of the file beside it, or none.
core::Rig rig_of(const path& video, const Config& config, const cv::Size& size_px) {
  core::Rig rig;
  if (!config.camera.empty()) {
    rig.cameras = {read_camera_file_for(config.camera, size_px, video)};
  } else if (const path beside = camera_file_beside(video); !beside.empty()) {
    const auto read = [&] {
      rig.cameras = {read_camera_file_for(beside, size_px, video)};
      spdlog::info("{}: taken for the camera of {}; --camera FILE names another", beside.string(),
                   video.filename().string());
    };
    read_if_sound("this camera file beside the video is not used", read);
  }
  if (!rig.cameras.empty()) rig.body_from_camera = {core::Rigid3{}};
  return rig;
}

void warn_of_rotation(const path& video, int rotation_degrees) {
  if (rotation_degrees == 0) return;
  // whether a quarter is one to the left or to the right, decoders do not agree
  spdlog::warn(
      "{}: notes that a player turns it by {}; its pictures are used as they are stored, and the "
      "calibration has to be of such pictures",
      video.string(), rotation_degrees == 180 ? "180 degrees" : "90 degrees to a side");
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
    const bool is_live = is_camera_device(video);
    if (!is_live) warn_of_rotation(video, decoder_->rotation_degrees());
    rig_ = std::make_shared<const core::Rig>(rig_of(video, config, size_px_));
    if (decoder_->frame_rate_hz() > 0.0) claim_.rate_hz = decoder_->frame_rate_hz();
    if (!is_live) claim_.num_frames = std::max(decoder_->num_frames(), 0);
    info_ = {.name = video.stem().string(),
             .format = is_live ? "camera" : "video",
             .num_frames = claim_.num_frames,
             .is_calibrated = rig_->is_calibrated(),
             .is_live = is_live,
             .is_video = !is_live,
             .frame_rate_hz = fps_ > 0.0 ? fps_ : claim_.rate_hz};
  }

  core::SourceInfo info() const override { return info_; }
  core::Truth truth() const override { return {}; }

  std::optional<core::Frame> next() override {
    VideoPicture picture = num_given_ == 0 ? std::exchange(waiting_, {}) : decoder_->next();
    if (picture.image.empty()) {
      check_end(path_, claim_, num_given_, last_told_s_ - first_told_s_ + 1.0 / claim_.rate_hz);
      return std::nullopt;
    }
    last_told_s_ = told_stamp_s(picture);
    if (num_given_ == 0) first_told_s_ = last_told_s_;
    core::Frame frame;
    frame.id = core::FrameId(num_given_);
    frame.stamp_s = fps_ > 0.0 ? static_cast<double>(num_given_) / fps_ : last_told_s_;
    frame.name = fmt::format("{} picture {}", path_.filename().string(), num_given_);
    frame.rig = rig_;
    frame.images = {std::move(picture.image)};
    if (frame.images[0].size() != size_px_) {
      throw InputError(fmt::format(
          "{}: picture {} is {} x {} pixels, expected {} x {} as the first", path_.string(),
          num_given_, frame.images[0].cols, frame.images[0].rows, size_px_.width, size_px_.height));
    }
    ++num_given_;
    return frame;
  }

 private:
  // The decoder's, made to rise: of the last pictures some decoders say 0.
  double told_stamp_s(const VideoPicture& picture) const {
    if (num_given_ == 0 || picture.stamp_s > last_told_s_) return picture.stamp_s;
    return last_told_s_ + 1.0 / claim_.rate_hz;
  }

  path path_;
  double fps_ = 0.0;  // 0: the stamps are the decoder's
  std::unique_ptr<VideoDecoder> decoder_;
  VideoPicture waiting_;  // the first, which is read early for its size
  cv::Size size_px_;
  std::shared_ptr<const core::Rig> rig_;
  core::SourceInfo info_;
  std::uint64_t num_given_ = 0;
  Claim claim_;
  double first_told_s_ = 0.0;
  double last_told_s_ = 0.0;
};

}  // namespace

bool is_video_name(std::string_view name) {
  std::string extension = path(name).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  constexpr std::array kExtensions = {".mp4",  ".avi",  ".mkv", ".mov", ".m4v", ".mpg",
                                      ".mpeg", ".webm", ".ogv", ".wmv", ".flv", ".mjpeg",
                                      ".mjpg", ".y4m",  ".ts",  ".mts", ".3gp", ".h264"};
  return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

bool is_camera_device(const path& path) {
  std::error_code error;  // where we may not look there is none
  return std::filesystem::is_character_file(path, error);
}

path camera_file_beside(const path& video) {
  if (is_camera_device(video)) return {};
  for (const path& file :
       {path(video.string() + ".camera.txt"), path(video).replace_extension(".camera.txt"),
        video.parent_path() / "camera.txt"}) {
    if (is_there(file)) return file;
  }
  return {};
}

std::unique_ptr<core::Source> open_video(const path& video, const Config& config,
                                         const path& plugin) {
  return std::make_unique<VideoSource>(video, config, plugin);
}

}  // namespace samewhere::input
