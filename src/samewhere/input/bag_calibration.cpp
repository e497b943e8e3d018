#include <optional>
#include <string>
#include <variant>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/bag_calibration.hpp>
#include <samewhere/input/bag_message.hpp>
#include <samewhere/input/camera_file.hpp>
#include <samewhere/input/message_image.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using std::filesystem::path;

core::Rigid3 rotation_of(const std::array<double, 9>& r) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  for (int i = 0; i < 9; ++i) matrix(i / 3, i % 3) = r[static_cast<std::size_t>(i)];
  const bool is_set = matrix.topLeftCorner<3, 3>().norm() > 0.0;
  return is_set ? core::Rigid3::from_matrix(matrix) : core::Rigid3{};
}

// As a pair was calibrated: R turns each camera to the axes of the rectified pair, P of the right
// one has its place along them. Nothing if P tells of no place.
std::optional<core::Rigid3> left_from_right(const messages::CameraInfo& left,
                                            const messages::CameraInfo& right, bool is_rectified) {
  if (right.p[0] == 0.0 || right.p[3] == 0.0) return std::nullopt;
  const core::Rigid3 rectified_left_from_right{.translation = {-right.p[3] / right.p[0], 0.0, 0.0}};
  if (is_rectified) return rectified_left_from_right;
  return core::inverse(rotation_of(left.r)) * rectified_left_from_right * rotation_of(right.r);
}

class BagRig {
 public:
  BagRig(const path& file, bags::BagReader& bag, const BagOpening& opening, const Config& config)
      : file_(file), bag_(bag), opening_(opening), topics_(opening.topics), config_(config) {}

  core::Rig read() {
    const auto camera = first_camera();
    if (!camera) return {};
    rig_.cameras = {*camera};
    rig_.body_from_camera = {core::Rigid3{}};
    if (topics_.right >= 0) add_right_camera();
    if (topics_.imu >= 0) add_imu();
    return rig_;
  }

 private:
  const std::string& name_of(int topic) const {
    return bag_.topics()[static_cast<std::size_t>(topic)].name;
  }
  const messages::CameraInfo* info_of(int topic) const {
    const auto found = opening_.infos.find(topic);
    return found == opening_.infos.end() ? nullptr : &found->second;
  }

  std::optional<core::Camera> first_camera() const {
    const auto told = camera_from(topics_.color, topics_.camera_info);
    if (config_.camera.empty()) return told;
    const FirstPicture& picture = opening_.pictures.at(topics_.color);
    return read_camera_file_for(config_.camera, picture.size_px, picture.name);
  }

  std::optional<core::Camera> camera_from(int topic, int info_topic) const {
    const messages::CameraInfo* info = info_of(info_topic);
    if (info == nullptr) return std::nullopt;
    const auto camera = camera_of(*info, is_rectified_name(name_of(topic)),
                                  fmt::format("{}: {}", file_.string(), name_of(info_topic)));
    if (!camera) return std::nullopt;
    const cv::Size size_px = opening_.pictures.at(topic).size_px;
    const cv::Size told_px = std::visit(
        [](const auto& model) { return cv::Size(model.width_px, model.height_px); }, *camera);
    if (told_px != size_px) {
      throw InputError(fmt::format("{}: {} tells of {} x {} pixels, expected {} x {} as {} has",
                                   file_.string(), name_of(info_topic), told_px.width,
                                   told_px.height, size_px.width, size_px.height, name_of(topic)));
    }
    return camera;
  }

  void add_right_camera() {
    const auto camera = camera_from(topics_.right, topics_.right_camera_info);
    const auto left_from_right = place_of_right_camera();
    if (!camera || !left_from_right) {
      spdlog::warn(
          "{}: {} is not used: the recording does not tell its calibration, or where it is",
          file_.string(), name_of(topics_.right));
      return;
    }
    rig_.cameras.push_back(*camera);
    rig_.body_from_camera.push_back(*left_from_right);
  }

  std::optional<core::Rigid3> place_of_right_camera() const {
    const messages::CameraInfo* left = info_of(topics_.camera_info);
    const messages::CameraInfo* right = info_of(topics_.right_camera_info);
    if (left != nullptr && right != nullptr) {
      const auto told = left_from_right(*left, *right, is_rectified_name(name_of(topics_.right)));
      if (told) return told;
    }
    return opening_.transforms.fixed(opening_.first_image(topics_.color).frame_id,
                                     opening_.first_image(topics_.right).frame_id);
  }

  void add_imu() {
    bag_.start({topics_.imu});
    const auto message = bag_.next();
    if (!message) return;
    const bags::Topic& topic = bag_.topics()[static_cast<std::size_t>(topics_.imu)];
    const std::string imu_frame =
        read_payload<messages::Imu>(file_, topic, *message).header.frame_id;
    const std::string& camera_frame = opening_.first_image(topics_.color).frame_id;
    if (const auto camera_from_imu = opening_.transforms.fixed(camera_frame, imu_frame))
      rig_.imu = core::Imu{.body_from_imu = *camera_from_imu};
  }

  const path& file_;
  bags::BagReader& bag_;
  const BagOpening& opening_;
  const BagTopics& topics_;
  const Config& config_;
  core::Rig rig_;
};

}  // namespace

core::Rig read_rig(const path& file, bags::BagReader& bag, const BagOpening& opening,
                   const Config& config) {
  try {
    return BagRig(file, bag, opening, config).read();
  } catch (const InputError& error) {
    if (config.needs_calibration) throw;
    spdlog::warn("{}; the calibration is not used", error.what());
  }
  return {};
}

}  // namespace samewhere::input
