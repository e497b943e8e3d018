#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/bags/bag.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file_kind.hpp>
#include <samewhere/core/median.hpp>
#include <samewhere/input/bag_poses.hpp>
#include <samewhere/input/bag_source.hpp>
#include <samewhere/input/camera_file.hpp>
#include <samewhere/input/message_image.hpp>

namespace samewhere::input {
namespace {

using bags::Message;
using bags::Topic;
using core::InputError;
using std::filesystem::path;

// REP-118: depth of 16 bits is in millimetres.
constexpr double kDepthUnitsOfMessages_per_m = 1000.0;
// Pictures that wait for partners: more do not come at once where a recording is in order.
constexpr std::size_t kMaxWaiting = 30;
// What arrives later than this was not recorded in order: another clock, or a recording played
// twice.
constexpr double kMaxBackwards_s = 1.0;
// Of so many pictures the rate is measured.
constexpr std::size_t kNumForRate = 100;

// A picture of either type, not yet decoded.
struct MessagePicture {
  double stamp_s = 0.0;
  std::string frame_id;
  std::string name;  // for messages: topic and stamp
  std::variant<messages::Image, messages::CompressedImage> content;

  cv::Mat image() const {
    return std::visit([this](const auto& message) { return image_of(message, name); }, content);
  }
  cv::Mat depth_m(double units_per_m) const {
    return std::visit(
        [this, units_per_m](const auto& message) { return depth_of(message, name, units_per_m); },
        content);
  }
};

template <class Payload>
Payload read_payload(const path& file, const Topic& topic, const Message& message) {
  try {
    return messages::read_message<Payload>(message.bytes, *bags::layout_of(topic));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}: a message at {:.6f} s {}", file.string(), topic.name,
                                 static_cast<double>(message.log_time_ns) * 1e-9, error.what()));
  }
}

MessagePicture read_picture(const path& file, const Topic& topic, const Message& message) {
  MessagePicture picture;
  const auto take = [&](auto payload) {
    const messages::Time zero;
    const messages::Time stamp = payload.header.stamp == zero
                                     ? messages::time_of_nanoseconds(message.log_time_ns)
                                     : payload.header.stamp;
    picture.stamp_s = messages::seconds(stamp);
    picture.frame_id = payload.header.frame_id;
    picture.name = fmt::format("{} {}.{:09}", topic.name, stamp.sec, stamp.nanosec);
    picture.content = std::move(payload);
  };
  if (is_compressed_topic(topic)) {
    take(read_payload<messages::CompressedImage>(file, topic, message));
  } else {
    take(read_payload<messages::Image>(file, topic, message));
  }
  return picture;
}

// ---- what the recording says before its first frame

struct Opening {
  std::vector<std::optional<FirstImage>> first;  // of each topic
  std::map<int, messages::CameraInfo> infos;     // of each topic of them, the first
  Transforms transforms;                         // static
};

// Reads until every topic of pictures and of calibrations has shown its first message.
Opening read_opening(const path& file, bags::BagReader& bag) {
  Opening opening;
  opening.transforms = read_transforms(bag, false);
  const std::vector<Topic>& topics = bag.topics();
  opening.first.resize(topics.size());
  std::vector<int> wanted;
  for (std::size_t i = 0; i < topics.size(); ++i) {
    const bool is_told = is_image_topic(topics[i]) || topics[i].type == "sensor_msgs/CameraInfo";
    if (is_told && topics[i].num_messages > 0 && bags::layout_of(topics[i]))
      wanted.push_back(static_cast<int>(i));
  }
  bag.start(wanted);
  std::size_t num_missing = wanted.size();
  while (num_missing > 0) {
    const auto message = bag.next();
    if (!message) break;
    const auto position = static_cast<std::size_t>(message->topic);
    const Topic& topic = topics[position];
    if (opening.first[position] || opening.infos.contains(message->topic)) continue;
    --num_missing;
    if (!is_image_topic(topic)) {
      opening.infos[message->topic] = read_payload<messages::CameraInfo>(file, topic, *message);
    } else if (is_compressed_topic(topic)) {
      const auto image = read_payload<messages::CompressedImage>(file, topic, *message);
      opening.first[position] = FirstImage{image.format, image.header.frame_id};
    } else {
      const auto image = read_payload<messages::Image>(file, topic, *message);
      opening.first[position] = FirstImage{image.encoding, image.header.frame_id};
    }
  }
  return opening;
}

// ---- calibration

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

class BagSource : public core::Source {
 public:
  BagSource(path file, const Config& config)
      : file_(std::move(file)), config_(config), bag_(bags::open_bag(file_)) {
    if (const bags::BagInfo& told = bag_->info(); !told.is_closed) {
      spdlog::warn("{}: was not closed by its recorder{}; it was read once to find what is in it",
                   file_.string(), told.damage.empty() ? "" : " and " + told.damage);
    }
    Opening opening = read_opening(file_, *bag_);
    topics_ = choose_topics(file_, bag_->topics(), opening.first, config_.topics);
    if (!config_.depth) topics_.depth = -1;
    for (const std::string& note : topics_.notes) spdlog::warn("{}: {}", file_.string(), note);
    // named by the user where it has none in the opening: it has no messages
    if (!opening.first[static_cast<std::size_t>(topics_.color)])
      throw InputError(
          fmt::format("{}: {} has no messages", file_.string(), name_of(topics_.color)));
    camera_frame_ = opening.first[static_cast<std::size_t>(topics_.color)]->frame_id;
    look_at_first_pictures();
    rig_ = std::make_shared<const core::Rig>(make_rig_if_needed(opening));
    if (rig_->cameras.size() == 1) topics_.right = -1;
    if (!rig_->imu) topics_.imu = -1;
    fill_info();
    start();
  }

  core::SourceInfo info() const override { return info_; }
  core::Truth truth() const override { return {.trajectory = true_trajectory()}; }
  core::Trajectory true_trajectory() const override {
    if (topics_.truth < 0) return {};
    return read_poses(*bags::open_bag(file_), topics_.truth, camera_frame_);
  }

  std::optional<core::Frame> next() override {
    while (!is_first_decided()) {
      const auto message = bag_->next();
      if (!message) {
        is_at_end_ = true;
      } else {
        take(*message);
      }
    }
    while (!waiting_.empty()) {
      if (auto frame = decide_first()) return frame;
      if (!is_first_decided()) return next();
    }
    tell_of_left_out();
    return std::nullopt;
  }

  const BagTopics& topics() const { return topics_; }

 private:
  const std::string& name_of(int topic) const {
    return bag_->topics()[static_cast<std::size_t>(topic)].name;
  }
  int partner_topic() const { return topics_.right >= 0 ? topics_.right : topics_.depth; }

  // Sizes belong to cameras, and the rate to what is counted in frames.
  void look_at_first_pictures() {
    std::vector<double> steps_s;
    std::optional<double> before_s;
    bag_->start(topics_.right >= 0 ? std::vector<int>{topics_.color, topics_.right}
                                   : std::vector<int>{topics_.color});
    while (steps_s.size() < kNumForRate || sizes_px_.size() < (topics_.right >= 0 ? 2U : 1U)) {
      const auto message = bag_->next();
      if (!message) break;
      const Topic& topic = bag_->topics()[static_cast<std::size_t>(message->topic)];
      const MessagePicture picture = read_picture(file_, topic, *message);
      if (!sizes_px_.contains(message->topic)) {
        sizes_px_[message->topic] = picture.image().size();
        first_names_[message->topic] = picture.name;
      }
      if (message->topic != topics_.color) continue;
      if (before_s && picture.stamp_s > *before_s) steps_s.push_back(picture.stamp_s - *before_s);
      before_s = picture.stamp_s;
    }
    if (const auto step_s = core::median(std::move(steps_s))) rate_hz_ = 1.0 / *step_s;
  }

  core::Rig make_rig_if_needed(const Opening& opening) {
    try {
      return make_rig(opening);
    } catch (const InputError& error) {
      if (config_.needs_calibration) throw;
      spdlog::warn("{}; the calibration is not used", error.what());
    }
    return {};
  }

  core::Rig make_rig(const Opening& opening) {
    core::Rig rig;
    const auto own = camera_from(opening, topics_.color, topics_.camera_info);
    if (!config_.camera.empty()) {
      rig.cameras = {read_camera_file_for(config_.camera, sizes_px_.at(topics_.color),
                                          first_names_.at(topics_.color))};
    } else if (own) {
      rig.cameras = {*own};
    } else {
      return {};
    }
    rig.body_from_camera = {core::Rigid3{}};
    if (topics_.right >= 0) add_right_camera(opening, rig);
    if (topics_.imu >= 0) add_imu(opening, rig);
    return rig;
  }

  std::optional<core::Camera> camera_from(const Opening& opening, int topic, int info_topic) const {
    const auto info = opening.infos.find(info_topic);
    if (info == opening.infos.end()) return std::nullopt;
    const auto camera = camera_of(info->second, is_rectified_name(name_of(topic)),
                                  fmt::format("{}: {}", file_.string(), name_of(info_topic)));
    if (!camera) return std::nullopt;
    const cv::Size size_px = sizes_px_.at(topic);
    const cv::Size told_px = std::visit(
        [](const auto& model) { return cv::Size(model.width_px, model.height_px); }, *camera);
    if (told_px != size_px) {
      throw InputError(fmt::format("{}: {} tells of {} x {} pixels, expected {} x {} as {} has",
                                   file_.string(), name_of(info_topic), told_px.width,
                                   told_px.height, size_px.width, size_px.height, name_of(topic)));
    }
    return camera;
  }

  void add_right_camera(const Opening& opening, core::Rig& rig) const {
    const auto camera = camera_from(opening, topics_.right, topics_.right_camera_info);
    const auto left_info = opening.infos.find(topics_.camera_info);
    const auto right_info = opening.infos.find(topics_.right_camera_info);
    std::optional<core::Rigid3> pose;
    if (left_info != opening.infos.end() && right_info != opening.infos.end())
      pose = left_from_right(left_info->second, right_info->second,
                             is_rectified_name(name_of(topics_.right)));
    if (!pose)
      pose = opening.transforms.fixed(
          camera_frame_, opening.first[static_cast<std::size_t>(topics_.right)]->frame_id);
    if (!camera || !pose) {
      spdlog::warn(
          "{}: {} is not used: the recording does not tell its calibration, or where it is",
          file_.string(), name_of(topics_.right));
      return;
    }
    rig.cameras.push_back(*camera);
    rig.body_from_camera.push_back(*pose);
  }

  void add_imu(const Opening& opening, core::Rig& rig) const {
    bag_->start({topics_.imu});
    const auto message = bag_->next();
    if (!message) return;
    const Topic& topic = bag_->topics()[static_cast<std::size_t>(topics_.imu)];
    const auto first = read_payload<messages::Imu>(file_, topic, *message);
    if (const auto pose = opening.transforms.fixed(camera_frame_, first.header.frame_id))
      rig.imu = core::Imu{.body_from_imu = *pose};
  }

  void fill_info() {
    const path whole = std::filesystem::weakly_canonical(file_);
    info_ = {.name = core::is_folder(whole) ? whole.filename().string() : whole.stem().string(),
             .format = bag_->info().format,
             .num_frames = static_cast<int>(
                 bag_->topics()[static_cast<std::size_t>(topics_.color)].num_messages),
             .has_depth = topics_.depth >= 0,
             .num_cameras = topics_.right >= 0 ? 2 : 1,
             .is_calibrated = rig_->is_calibrated(),
             .frame_rate_hz = rate_hz_};
  }

  void start() {
    std::vector<int> used = {topics_.color};
    for (const int topic : {topics_.right, topics_.depth, topics_.imu})
      if (topic >= 0) used.push_back(topic);
    bag_->start(used);
  }

  // ---- streaming

  void take(const Message& message) {
    const Topic& topic = bag_->topics()[static_cast<std::size_t>(message.topic)];
    if (message.topic == topics_.imu) {
      const auto sample = read_payload<messages::Imu>(file_, topic, message);
      const auto vector = [](const messages::Vector3& v) { return Eigen::Vector3d(v.x, v.y, v.z); };
      imu_.push_back({.stamp_s = messages::seconds(sample.header.stamp),
                      .angular_velocity_rad_s = vector(sample.angular_velocity),
                      .acceleration_m_s2 = vector(sample.linear_acceleration)});
      return;
    }
    MessagePicture picture = read_picture(file_, topic, message);
    const bool is_color = message.topic == topics_.color;
    if (is_color) check_color(picture);
    std::deque<MessagePicture>& queue = is_color ? waiting_ : partners_;
    const auto place = std::upper_bound(
        queue.begin(), queue.end(), picture.stamp_s,
        [](double stamp_s, const MessagePicture& other) { return stamp_s < other.stamp_s; });
    const bool is_twice = place != queue.begin() && std::prev(place)->stamp_s == picture.stamp_s;
    if (is_color && (is_twice || (last_stamp_s_ && picture.stamp_s <= *last_stamp_s_))) {
      ++num_out_of_order_;
      return;
    }
    queue.insert(place, std::move(picture));
  }

  void check_color(const MessagePicture& picture) const {
    if (picture.frame_id != camera_frame_) {
      throw InputError(
          fmt::format("{}: {}: its frame is '{}', those before had '{}'; expected one "
                      "camera on a topic",
                      file_.string(), picture.name, picture.frame_id, camera_frame_));
    }
    if (last_stamp_s_ && picture.stamp_s < *last_stamp_s_ - kMaxBackwards_s) {
      throw InputError(
          fmt::format("{}: {}: its stamp is {:.3f} s before that of the frame before; "
                      "expected stamps that rise",
                      file_.string(), picture.name, *last_stamp_s_ - picture.stamp_s));
    }
  }

  // Whether no message that is still to come can change the partner of the first picture.
  bool is_first_decided() const {
    if (is_at_end_) return true;
    if (waiting_.size() > kMaxWaiting) return true;
    if (waiting_.size() < 2) return false;
    if (partner_topic() < 0) return true;
    const double due_s = waiting_.front().stamp_s + config_.max_stamp_difference_s;
    return !partners_.empty() && partners_.back().stamp_s > due_s &&
           waiting_.back().stamp_s > due_s;
  }

  // Nothing if the first picture is left out.
  std::optional<core::Frame> decide_first() {
    MessagePicture color = std::move(waiting_.front());
    waiting_.pop_front();
    std::optional<MessagePicture> partner = take_partner(color.stamp_s);
    if (topics_.right >= 0 && !partner) {
      ++num_without_right_;
      return std::nullopt;
    }
    last_stamp_s_ = color.stamp_s;
    core::Frame frame;
    frame.id = core::FrameId(num_given_++);
    frame.stamp_s = color.stamp_s;
    frame.name = color.name;
    frame.rig = rig_;
    frame.images = {color.image()};
    check_size(color.name, frame.images[0], topics_.color);
    if (topics_.right >= 0) {
      frame.images.push_back(partner->image());
      check_size(partner->name, frame.images[1], topics_.right);
    } else if (partner) {
      frame.depth_m = partner->depth_m(depth_units_per_m());
      check_size(partner->name, *frame.depth_m, topics_.color);
    } else if (topics_.depth >= 0) {
      ++num_without_depth_;
    }
    while (!imu_.empty() && imu_.front().stamp_s <= frame.stamp_s) {
      frame.imu_since_last.push_back(imu_.front());
      imu_.pop_front();
    }
    return frame;
  }

  double depth_units_per_m() const {
    return config_.depth_factor > 0.0 ? config_.depth_factor : kDepthUnitsOfMessages_per_m;
  }

  // The nearest in time, unless the next picture is nearer to it. Partners before it are of no use
  // any more.
  std::optional<MessagePicture> take_partner(double stamp_s) {
    const auto distance_s = [](const MessagePicture& picture, double moment_s) {
      return std::abs(picture.stamp_s - moment_s);
    };
    const auto nearest = std::min_element(partners_.begin(), partners_.end(),
                                          [&](const MessagePicture& a, const MessagePicture& b) {
                                            return distance_s(a, stamp_s) < distance_s(b, stamp_s);
                                          });
    if (nearest == partners_.end() ||
        distance_s(*nearest, stamp_s) > config_.max_stamp_difference_s ||
        (!waiting_.empty() &&
         distance_s(*nearest, waiting_.front().stamp_s) < distance_s(*nearest, stamp_s))) {
      drop_partners_before(stamp_s - config_.max_stamp_difference_s);
      return std::nullopt;
    }
    num_unused_ += static_cast<int>(nearest - partners_.begin());
    MessagePicture partner = std::move(*nearest);
    partners_.erase(partners_.begin(), std::next(nearest));
    return partner;
  }

  void drop_partners_before(double stamp_s) {
    while (!partners_.empty() && partners_.front().stamp_s < stamp_s) {
      partners_.pop_front();
      ++num_unused_;
    }
  }

  void check_size(const std::string& name, const cv::Mat& image, int topic) const {
    const cv::Size size_px = sizes_px_.at(topic);
    if (image.size() == size_px) return;
    throw InputError(fmt::format("{}: {}: is {} x {} pixels, expected {} x {} as the first image",
                                 file_.string(), name, image.cols, image.rows, size_px.width,
                                 size_px.height));
  }

  void tell_of_left_out() {
    if (std::exchange(is_told_, true)) return;
    num_unused_ += static_cast<int>(partners_.size());
    const auto warn = [this](int count, const char* what) {
      if (count > 0) spdlog::warn("{}: {} {}", file_.string(), count, what);
    };
    warn(num_out_of_order_, "pictures are left out: their stamps do not rise");
    warn(num_without_right_, "pictures are left out: they have no partner of the second camera");
    warn(num_without_depth_, "pictures have no depth near in time (input.max_stamp_difference_s)");
    warn(num_unused_, "pictures of depth or of the second camera belong to no picture");
    if (!bag_->info().damage.empty()) {
      throw InputError(fmt::format("{}: {}; {} frames were read from it", file_.string(),
                                   bag_->info().damage, num_given_));
    }
  }

  path file_;
  Config config_;
  std::unique_ptr<bags::BagReader> bag_;
  BagTopics topics_;
  std::string camera_frame_;
  std::map<int, cv::Size> sizes_px_;        // by topics of pictures
  std::map<int, std::string> first_names_;  // the same
  double rate_hz_ = 0.0;
  std::shared_ptr<const core::Rig> rig_;
  core::SourceInfo info_;

  std::deque<MessagePicture> waiting_;   // pictures of camera 0, stamps rise
  std::deque<MessagePicture> partners_;  // depth, or pictures of camera 1, stamps rise
  std::deque<core::ImuSample> imu_;
  bool is_at_end_ = false;
  std::optional<double> last_stamp_s_;
  std::uint64_t num_given_ = 0;
  int num_out_of_order_ = 0;
  int num_without_right_ = 0;
  int num_without_depth_ = 0;
  int num_unused_ = 0;
  bool is_told_ = false;
};

}  // namespace

std::unique_ptr<core::Source> open_bag_source(const path& file, const Config& config) {
  return std::make_unique<BagSource>(file, config);
}

BagTopics topics_of_bag(const path& file, const Config& config) {
  return BagSource(file, config).topics();
}

}  // namespace samewhere::input
