#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/nanoseconds.hpp>
#include <samewhere/core/progress.hpp>
#include <samewhere/input/message_image.hpp>
#include <samewhere/input/transforms.hpp>
#include <samewhere/report/jpeg.hpp>
#include <samewhere/run/bag_export.hpp>

namespace samewhere::run {
namespace {

using core::InputError;
using std::filesystem::path;

constexpr const char* kCameraFrame = "camera_optical_frame";
constexpr const char* kRightFrame = "right_camera_optical_frame";
constexpr const char* kImuFrame = "imu_frame";
constexpr const char* kWorldFrame = "world";

messages::Header header_of(double stamp_s, const char* frame) {
  return {.stamp = messages::time_of(stamp_s), .frame_id = frame};
}

messages::Image image_of(const cv::Mat& pixels, const char* encoding) {
  messages::Image image;
  image.height = static_cast<std::uint32_t>(pixels.rows);
  image.width = static_cast<std::uint32_t>(pixels.cols);
  image.encoding = encoding;
  const std::size_t row = static_cast<std::size_t>(pixels.cols) * pixels.elemSize();
  image.step = static_cast<std::uint32_t>(row);
  image.data.resize(row * static_cast<std::size_t>(pixels.rows));
  for (int y = 0; y < pixels.rows; ++y)
    std::memcpy(image.data.data() + row * static_cast<std::size_t>(y), pixels.ptr(y), row);
  return image;
}

// The topics of one camera.
struct CameraTopics {
  int image = -1;
  int info = -1;  // -1: not calibrated
  const char* frame = kCameraFrame;
};

class BagRecording {
 public:
  BagRecording(core::Source& source, bags::BagWriter& bag, bool is_jpeg)
      : source_(source), bag_(bag), is_jpeg_(is_jpeg), truth_(source.true_trajectory()) {}

  int write(bool is_quiet) {
    core::Progress progress("writing", source_.info().num_frames, is_quiet);
    int num_frames = 0;
    while (const auto frame = source_.next()) {
      core::stop_if_interrupted();
      if (num_frames == 0) declare(*frame);
      write_truth_until(frame->stamp_s);
      write_frame(*frame);
      progress.update(++num_frames);
    }
    if (num_frames > 0) write_truth_until(truth_.empty() ? 0.0 : truth_.back().stamp_s);
    return num_frames;
  }

 private:
  static std::int64_t time_ns(double stamp_s) { return core::nanoseconds_of(stamp_s); }

  int image_topic(const std::string& name) {
    return is_jpeg_ ? bag_.add_topic<messages::CompressedImage>(name + "/compressed")
                    : bag_.add_topic<messages::Image>(name);
  }

  void declare(const core::Frame& frame) {
    const bool is_pair = frame.images.size() > 1;
    const std::string first = is_pair ? "/camera/left" : "/camera/color";
    cameras_.push_back({.image = image_topic(first + "/image_raw")});
    if (is_pair)
      cameras_.push_back({.image = image_topic("/camera/right/image_raw"), .frame = kRightFrame});
    for (std::size_t i = 0; i < frame.rig->cameras.size() && i < cameras_.size(); ++i)
      cameras_[i].info = bag_.add_topic<messages::CameraInfo>((i == 0 ? first : "/camera/right") +
                                                              std::string("/camera_info"));
    if (source_.info().has_depth)
      depth_ = bag_.add_topic<messages::Image>("/camera/aligned_depth_to_color/image_raw");
    if (frame.rig->imu) imu_ = bag_.add_topic<messages::Imu>("/imu/data");
    if (!truth_.empty())
      ground_truth_ = bag_.add_topic<messages::Odometry>("/ground_truth/odometry");
    write_fixed_transforms(frame);
  }

  void write_fixed_transforms(const core::Frame& frame) {
    messages::TFMessage fixed;
    const auto add = [&](const char* child, const core::Rigid3& camera_from_child) {
      fixed.transforms.push_back({.header = header_of(frame.stamp_s, kCameraFrame),
                                  .child_frame_id = child,
                                  .transform = input::transform_of(camera_from_child)});
    };
    const core::Rig& rig = *frame.rig;
    if (rig.is_calibrated() && cameras_.size() > 1 && rig.cameras.size() > 1)
      add(kRightFrame, core::inverse(rig.body_from_camera[0]) * rig.body_from_camera[1]);
    if (rig.is_calibrated() && rig.imu)
      add(kImuFrame, core::inverse(rig.body_from_camera[0]) * rig.imu->body_from_imu);
    if (fixed.transforms.empty()) return;
    const int topic = bag_.add_topic<messages::TFMessage>("/tf_static", true);
    bag_.write_message(topic, time_ns(frame.stamp_s), fixed);
  }

  void write_truth_until(double stamp_s) {
    for (; next_truth_ < truth_.size() && truth_[next_truth_].stamp_s <= stamp_s; ++next_truth_) {
      const core::StampedPose& pose = truth_[next_truth_];
      const messages::Transform transform = input::transform_of(pose.world_from_camera);
      messages::Odometry odometry;
      odometry.header = header_of(pose.stamp_s, kWorldFrame);
      odometry.child_frame_id = kCameraFrame;
      odometry.pose.pose = {transform.translation, transform.rotation};
      bag_.write_message(ground_truth_, time_ns(pose.stamp_s), odometry);
    }
  }

  void write_frame(const core::Frame& frame) {
    const std::int64_t now_ns = time_ns(frame.stamp_s);
    for (const core::ImuSample& sample : frame.imu_since_last) write_imu(sample);
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      const messages::Header header = header_of(frame.stamp_s, cameras_[i].frame);
      write_picture(cameras_[i].image, now_ns, header, frame.images[i]);
      if (cameras_[i].info < 0) continue;
      messages::CameraInfo info = input::camera_info_of(frame.rig->cameras[i]);
      info.header = header;
      bag_.write_message(cameras_[i].info, now_ns, info);
    }
    if (!frame.depth_m) return;
    messages::Image depth = image_of(*frame.depth_m, "32FC1");
    depth.header = header_of(frame.stamp_s, kCameraFrame);
    bag_.write_message(depth_, now_ns, depth);
  }

  void write_picture(int topic, std::int64_t now_ns, const messages::Header& header,
                     const cv::Mat& picture) {
    if (is_jpeg_) {
      const std::string jpeg = report::jpeg_bytes(picture, picture.cols);
      bag_.write_message(topic, now_ns,
                         messages::CompressedImage{header, "jpeg", {jpeg.begin(), jpeg.end()}});
      return;
    }
    messages::Image image = image_of(picture, picture.channels() == 1 ? "mono8" : "bgr8");
    image.header = header;
    bag_.write_message(topic, now_ns, image);
  }

  void write_imu(const core::ImuSample& sample) {
    if (imu_ < 0) return;
    messages::Imu imu;
    imu.header = header_of(sample.stamp_s, kImuFrame);
    imu.orientation_covariance[0] = -1.0;  // sensor_msgs: the orientation is not known
    const auto& rate = sample.angular_velocity_rad_s;
    imu.angular_velocity = {rate.x(), rate.y(), rate.z()};
    const auto& acceleration = sample.acceleration_m_s2;
    imu.linear_acceleration = {acceleration.x(), acceleration.y(), acceleration.z()};
    bag_.write_message(imu_, time_ns(sample.stamp_s), imu);
  }

  core::Source& source_;
  bags::BagWriter& bag_;
  bool is_jpeg_;
  core::Trajectory truth_;
  std::size_t next_truth_ = 0;
  std::vector<CameraTopics> cameras_;
  int depth_ = -1;
  int imu_ = -1;
  int ground_truth_ = -1;
};

int write_file_of_bag(core::Source& source, const path& file, const BagOptions& options,
                      bool is_quiet) {
  const auto bag = bags::make_bag(file, options.format, options.compression);
  const int num_frames = BagRecording(source, *bag, options.is_jpeg).write(is_quiet);
  if (num_frames == 0) throw InputError(source.info().name + ": gives no frame");
  bag->finish();
  return num_frames;
}

}  // namespace

bags::BagFormat bag_format_of(const path& file) {
  const std::string ending = file.extension().string();
  if (ending == ".mcap" || ending.empty()) return bags::BagFormat::kMcap;
  if (ending == ".db3") return bags::BagFormat::kSqlite;
  if (ending == ".bag") return bags::BagFormat::kRos1;
  throw InputError(
      fmt::format("{}: ends in {}, expected .mcap, .db3, .bag, or no ending for a "
                  "folder of rosbag2",
                  file.string(), ending));
}

int write_bag(core::Source& source, const path& file, const BagOptions& options, bool is_quiet) {
  if (core::is_there(file)) throw InputError(file.string() + ": is there already");
  if (file.has_extension()) return write_file_of_bag(source, file, options, is_quiet);
  if (options.format == bags::BagFormat::kRos1)
    throw InputError(file.string() +
                     ": a ROS 1 bag is one file, expected a name that ends in .bag");
  core::make_writable_folder(file);
  const std::string ending = options.format == bags::BagFormat::kMcap ? ".mcap" : ".db3";
  const std::string name = file.filename().string() + "_0" + ending;
  const int num_frames = write_file_of_bag(source, file / name, options, is_quiet);
  core::write_file(file / "metadata.yaml",
                   bags::rosbag2_metadata(*bags::open_bag(file / name), name));
  return num_frames;
}

}  // namespace samewhere::run
