#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/geometry/camera_check.hpp>
#include <samewhere/input/calibration.hpp>
#include <samewhere/input/camera_file.hpp>
#include <samewhere/input/rectify.hpp>
#include <samewhere/library/border.hpp>
#include <samewhere/library/convert.hpp>
#include <samewhere/library/frame_intake.hpp>
#include <samewhere/library/pictures.hpp>
#include <samewhere/run/open_source.hpp>

namespace samewhere::library {
namespace {

core::Camera camera_of(const Camera& given, const std::string& name) {
  const cv::Size size(given.width_px, given.height_px);
  if (size.width <= 0 || size.height <= 0) {
    throw core::InputError(fmt::format("{}: {} x {} pixels; expected the size of its images", name,
                                       size.width, size.height));
  }
  return input::with_size(input::camera_of({.place = name,
                                            .size_px = size,
                                            .fx_px = given.fx_px,
                                            .fy_px = given.fy_px,
                                            .cx_px = given.cx_px,
                                            .cy_px = given.cy_px,
                                            .is_fisheye = given.lens == Lens::kFisheye,
                                            .distortion = given.distortion}),
                          size);
}

std::shared_ptr<const core::Rig> rig_of(const Calibration& calibration) {
  core::Rig rig;
  const std::size_t num_cameras = calibration.cameras.size();
  if (num_cameras < 1 || num_cameras > 2) {
    throw core::InputError(
        fmt::format("calibration: {} cameras; expected one, or two of a stereo pair", num_cameras));
  }
  if (!(calibration.frame_rate_hz > 0.0)) {
    throw core::InputError(fmt::format("calibration: frame rate {} Hz; expected more than 0",
                                       calibration.frame_rate_hz));
  }
  for (std::size_t i = 0; i < num_cameras; ++i) {
    const Camera& camera = calibration.cameras[i];
    const std::string name = fmt::format("calibration: camera {}", i);
    if (!is_rigid(camera.body_from_camera)) {
      throw core::InputError(name +
                             ": body_from_camera is not finite or no rotation; expected a "
                             "rigid pose");
    }
    rig.cameras.push_back(camera_of(camera, name));
    rig.body_from_camera.push_back(rigid_of(camera.body_from_camera));
  }
  return std::make_shared<const core::Rig>(std::move(rig));
}

}  // namespace

// A source of the frames that are given to it one by one.
class FrameIntake::Given final : public core::Source {
 public:
  explicit Given(const Calibration& calibration)
      : calibration_(calibration), rig_(rig_of(calibration)) {}

  core::SourceInfo info() const override {
    return {.name = "live",
            .format = "live",
            .has_depth = calibration_.has_depth,
            .num_cameras = static_cast<int>(rig_->cameras.size()),
            .is_calibrated = true,
            .frame_rate_hz = calibration_.frame_rate_hz};
  }
  core::Truth truth() const override { return {}; }

  void give(const Frame& frame) {
    core::Frame given{.id = core::FrameId(num_taken_), .stamp_s = frame.stamp_s, .rig = rig_};
    for (const Image& image : frame.images) given.images.push_back(picture_of(image));
    if (frame.depth) given.depth_m = depth_of(*frame.depth);
    next_ = std::move(given);
  }

  std::optional<core::Frame> next() override {
    last_stamp_s_ = next_->stamp_s;
    ++num_taken_;
    return std::exchange(next_, std::nullopt);
  }

  void check(const Frame& frame) const {
    const std::string name = fmt::format("frame {}", num_taken_);
    if (!std::isfinite(frame.stamp_s))
      throw core::InputError(fmt::format("{}: stamp {} s; expected a number", name, frame.stamp_s));
    if (last_stamp_s_ && frame.stamp_s <= *last_stamp_s_) {
      throw core::InputError(fmt::format("{}: stamp {} s; expected a later one than {} s", name,
                                         frame.stamp_s, *last_stamp_s_));
    }
    if (frame.images.size() != calibration_.cameras.size()) {
      throw core::InputError(fmt::format("{}: {} images; expected {}, one per camera", name,
                                         frame.images.size(), calibration_.cameras.size()));
    }
    for (std::size_t i = 0; i < frame.images.size(); ++i) {
      check_size(fmt::format("{}: image {}", name, i), frame.images[i], i, false);
    }
    if (!frame.depth) return;
    if (!calibration_.has_depth)
      throw core::InputError(name + ": has depth; expected none, as Calibration::has_depth says");
    check_size(name + ": depth", *frame.depth, 0, true);
  }

 private:
  void check_size(const std::string& name, const Image& image, std::size_t camera,
                  bool is_depth) const {
    check_image(name, image, is_depth);
    const Camera& expected = calibration_.cameras[camera];
    if (image.width_px == expected.width_px && image.height_px == expected.height_px) return;
    throw core::InputError(fmt::format("{}: {} x {} pixels; expected {} x {} as in the calibration",
                                       name, image.width_px, image.height_px, expected.width_px,
                                       expected.height_px));
  }

  Calibration calibration_;
  std::shared_ptr<const core::Rig> rig_;
  std::optional<core::Frame> next_;
  std::optional<double> last_stamp_s_;
  std::uint64_t num_taken_ = 0;
};

FrameIntake::FrameIntake(const Calibration& calibration, const pipeline::Config& config) {
  auto given = std::make_unique<Given>(calibration);
  given_ = given.get();
  source_ = run::for_slam(input::rectified(std::move(given)), config);
}

FrameIntake::~FrameIntake() = default;

core::SourceInfo FrameIntake::info() const { return source_->info(); }

bool FrameIntake::is_without_scale() const { return run::is_scale_free(source_->info()); }

void FrameIntake::check(const Frame& frame) const { given_->check(frame); }

core::Frame FrameIntake::take(const Frame& frame) {
  given_->give(frame);
  return *source_->next();
}

}  // namespace samewhere::library

namespace samewhere {

Camera read_camera(const std::filesystem::path& file, int width_px, int height_px) {
  return library::at_border([&] {
    const core::Camera read = input::read_camera_file_for(file, {width_px, height_px}, file);
    return library::camera_of(read, width_px, height_px);
  });
}

}  // namespace samewhere
