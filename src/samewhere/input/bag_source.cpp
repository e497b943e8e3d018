#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/bags/bag.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file_kind.hpp>
#include <samewhere/input/bag_calibration.hpp>
#include <samewhere/input/bag_message.hpp>
#include <samewhere/input/bag_opening.hpp>
#include <samewhere/input/bag_picture.hpp>
#include <samewhere/input/bag_poses.hpp>
#include <samewhere/input/bag_source.hpp>

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
// Partners that wait for pictures, which may come later by some seconds.
constexpr std::size_t kMaxPartners = 100;
// What arrives later than this was not recorded in order: another clock, or a recording played
// twice.
constexpr double kMaxBackwards_s = 1.0;

class BagSource : public core::Source {
 public:
  BagSource(path file, const Config& config)
      : file_(std::move(file)), config_(config), bag_(bags::open_bag(file_)) {
    if (const bags::BagInfo& told = bag_->info(); !told.is_closed) {
      spdlog::warn("{}: was not closed by its recorder{}; it was read once to find what is in it",
                   file_.string(), told.damage.empty() ? "" : " and " + told.damage);
    }
    const BagOpening opening = read_opening(file_, *bag_, config_);
    topics_ = opening.topics;
    camera_frame_ = opening.first_image(topics_.color).frame_id;
    for (const auto& [topic, picture] : opening.pictures) sizes_px_[topic] = picture.size_px;
    rig_ = std::make_shared<const core::Rig>(read_rig(file_, *bag_, opening, config_));
    if (rig_->cameras.size() == 1) topics_.right = -1;
    if (!rig_->imu) topics_.imu = -1;
    fill_info(opening.frame_rate_hz);
    start();
  }

  core::SourceInfo info() const override { return info_; }
  core::Truth truth() const override { return {.trajectory = true_trajectory()}; }
  core::Trajectory true_trajectory() const override {
    if (topics_.truth < 0) return {};
    return read_poses(*bags::open_bag(file_), topics_.truth, camera_frame_);
  }

  std::optional<core::Frame> next() override {
    while (true) {
      read_until_first_is_decided();
      if (waiting_.empty()) break;
      if (auto frame = decide_first()) return frame;
    }
    tell_of_left_out();
    return std::nullopt;
  }

  const BagTopics& topics() const { return topics_; }

 private:
  int partner_topic() const { return topics_.right >= 0 ? topics_.right : topics_.depth; }

  void fill_info(double frame_rate_hz) {
    const path whole = std::filesystem::weakly_canonical(file_);
    info_ = {.name = core::is_folder(whole) ? whole.filename().string() : whole.stem().string(),
             .format = bag_->info().format,
             .num_frames = static_cast<int>(
                 bag_->topics()[static_cast<std::size_t>(topics_.color)].num_messages),
             .has_depth = topics_.depth >= 0,
             .num_cameras = topics_.right >= 0 ? 2 : 1,
             .is_calibrated = rig_->is_calibrated(),
             .frame_rate_hz = frame_rate_hz};
  }

  void start() {
    std::vector<int> used = {topics_.color};
    for (const int topic : {topics_.right, topics_.depth, topics_.imu})
      if (topic >= 0) used.push_back(topic);
    bag_->start(used);
  }

  // ---- streaming

  void read_until_first_is_decided() {
    while (!is_first_decided()) {
      if (const auto message = bag_->next()) {
        take(*message);
      } else {
        is_at_end_ = true;
      }
    }
  }

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
    BagPicture picture = read_picture(file_, topic, message);
    const bool is_color = message.topic == topics_.color;
    if (is_color) check_color(picture);
    std::deque<BagPicture>& queue = is_color ? waiting_ : partners_;
    const auto place = std::upper_bound(
        queue.begin(), queue.end(), picture.stamp_s,
        [](double stamp_s, const BagPicture& other) { return stamp_s < other.stamp_s; });
    const bool is_twice = place != queue.begin() && std::prev(place)->stamp_s == picture.stamp_s;
    if (is_color && (is_twice || (last_stamp_s_ && picture.stamp_s <= *last_stamp_s_))) {
      ++num_out_of_order_;
      return;
    }
    queue.insert(place, std::move(picture));
    // of pictures that have not begun, or have ended
    if (waiting_.empty() && partners_.size() > kMaxPartners) {
      partners_.pop_front();
      ++num_unused_;
    }
  }

  void check_color(const BagPicture& picture) const {
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
    if (is_at_end_ || waiting_.size() > kMaxWaiting) return true;
    if (waiting_.empty()) return false;
    if (partner_topic() < 0) return waiting_.size() > 1;
    const double due_s = waiting_.front().stamp_s + config_.max_stamp_difference_s;
    if (partners_.empty() || partners_.back().stamp_s <= due_s) return false;
    // many partners: the pictures have ended, and these have not
    return waiting_.back().stamp_s > due_s || partners_.size() > kMaxPartners;
  }

  // Nothing if the first picture is left out.
  std::optional<core::Frame> decide_first() {
    BagPicture color = std::move(waiting_.front());
    waiting_.pop_front();
    std::optional<BagPicture> partner = take_partner(color.stamp_s);
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
  std::optional<BagPicture> take_partner(double stamp_s) {
    const auto distance_s = [](const BagPicture& picture, double moment_s) {
      return std::abs(picture.stamp_s - moment_s);
    };
    const auto nearest = std::min_element(partners_.begin(), partners_.end(),
                                          [&](const BagPicture& a, const BagPicture& b) {
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
    BagPicture partner = std::move(*nearest);
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
  std::map<int, cv::Size> sizes_px_;  // by topics of pictures
  std::shared_ptr<const core::Rig> rig_;
  core::SourceInfo info_;

  std::deque<BagPicture> waiting_;   // pictures of camera 0, stamps rise
  std::deque<BagPicture> partners_;  // depth, or pictures of camera 1, stamps rise
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
