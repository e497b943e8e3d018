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
#include <samewhere/input/stereo_pair.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using std::filesystem::path;

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
    const auto first_from_right = place_of_right_camera();
    if (!camera || !first_from_right) {
      spdlog::warn("{}: {} is not used: {}", file_.string(), name_of(topics_.right),
                   camera ? first_from_right.error() : "the recording has no calibration of it");
      return;
    }
    rig_.cameras.push_back(*camera);
    rig_.body_from_camera.push_back(*first_from_right);
  }

  Result<core::Rigid3, std::string> place_of_right_camera() const {
    const messages::CameraInfo* left = info_of(topics_.camera_info);
    const messages::CameraInfo* right = info_of(topics_.right_camera_info);
    std::string reason = "there is no camera_info of both cameras";
    if (left != nullptr && right != nullptr) {
      const auto told = left_from_right(*left, *right, is_rectified_name(name_of(topics_.right)));
      if (told) return told;
      reason = told.error();
    }
    const std::string left_frame = frame_name(opening_.first_image(topics_.color).frame_id);
    const std::string right_frame = frame_name(opening_.first_image(topics_.right).frame_id);
    const auto fixed = opening_.transforms.fixed(left_frame, right_frame);
    if (fixed && left_frame != right_frame) return *fixed;
    return refuse(fmt::format("{}; /tf_static does not tell where '{}' is on '{}'", reason,
                              right_frame, left_frame));
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
