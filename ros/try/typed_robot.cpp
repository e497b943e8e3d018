// samewhere-typed-robot BAG TRAJECTORY: a robot whose messages are read and written by code that
// Cyclone DDS's compiler made of their IDL, as that of a node of ROS 2 is. Plays the images and
// camera info of an MCAP bag at real time, asks the node to pause, checks the fields of what it
// tells and writes the poses of /tf as a TUM file. Ends with 2 if something is wrong or missing.

#include <chrono>
#include <cstdlib>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <dds/dds.h>
#include <fmt/format.h>

#include "messages.h"
#include <samewhere/bags/bag.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/program.hpp>
#include <samewhere/core/terminal.hpp>
#include <samewhere/core/tum_file.hpp>

namespace samewhere {
namespace {

using core::InputError;

dds_entity_t checked(dds_entity_t entity) {
  if (entity < 0) throw InputError(fmt::format("DDS: {}", dds_strretcode(-entity)));
  return entity;
}

void expect(bool is_so, const std::string& what) {
  if (!is_so) throw InputError("expected " + what);
}

struct Robot {
  Robot() : participant(checked(dds_create_participant(domain(), nullptr, nullptr))) {}
  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;
  ~Robot() { dds_delete(participant); }

  static dds_domainid_t domain() {
    const char* id = std::getenv("ROS_DOMAIN_ID");
    return static_cast<dds_domainid_t>(id == nullptr ? 0 : std::atoi(id));
  }
  dds_entity_t topic(const std::string& name, const dds_topic_descriptor_t& type) const {
    return checked(dds_create_topic(participant, &type, ("rt" + name).c_str(), nullptr, nullptr));
  }
  dds_entity_t writer(const std::string& name, const dds_topic_descriptor_t& type) const {
    return checked(dds_create_writer(participant, topic(name, type), reliable(5), nullptr));
  }
  dds_entity_t reader(const std::string& name, const dds_topic_descriptor_t& type) const {
    return checked(dds_create_reader(participant, topic(name, type), reliable(1000), nullptr));
  }
  static const dds_qos_t* reliable(int depth) {
    static std::map<int, dds_qos_t*> known;  // as long as the program
    dds_qos_t*& qos = known[depth];
    if (qos == nullptr) {
      qos = dds_create_qos();
      dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
      dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, depth);
    }
    return qos;
  }

  dds_entity_t participant;
};

// ---- what is sent

char* text(const std::string& value) { return const_cast<char*>(value.c_str()); }

std_msgs_msg_dds__Header_ typed(const messages::Header& header) {
  return {.stamp_ = {header.stamp.sec, header.stamp.nanosec}, .frame_id_ = text(header.frame_id)};
}

void send(dds_entity_t writer, messages::Image& image) {
  sensor_msgs_msg_dds__Image_ message{};
  message.header_ = typed(image.header);
  message.height_ = image.height;
  message.width_ = image.width;
  message.encoding_ = text(image.encoding);
  message.is_bigendian_ = image.is_bigendian;
  message.step_ = image.step;
  message.data_._length = message.data_._maximum = static_cast<std::uint32_t>(image.data.size());
  message.data_._buffer = image.data.data();
  checked(dds_write(writer, &message));
}

void send(dds_entity_t writer, messages::CameraInfo& info) {
  sensor_msgs_msg_dds__CameraInfo_ message{};
  message.header_ = typed(info.header);
  message.height_ = info.height;
  message.width_ = info.width;
  message.distortion_model_ = text(info.distortion_model);
  message.d_._length = message.d_._maximum = static_cast<std::uint32_t>(info.d.size());
  message.d_._buffer = info.d.data();
  std::copy(info.k.begin(), info.k.end(), message.k_);
  std::copy(info.r.begin(), info.r.end(), message.r_);
  std::copy(info.p.begin(), info.p.end(), message.p_);
  checked(dds_write(writer, &message));
}

// ---- what is received

template <class Message, class Use>
void take_all(dds_entity_t reader, const Use& use) {
  void* sample = nullptr;
  dds_sample_info_t info;
  while (true) {
    const dds_return_t count = dds_take(reader, &sample, &info, 1, 1);
    if (checked(count) == 0) return;
    if (info.valid_data) use(*static_cast<const Message*>(sample));
    dds_return_loan(reader, &sample, count);
    sample = nullptr;
  }
}

core::Rigid3 rigid(const geometry_msgs_msg_dds__Transform_& transform) {
  const auto& t = transform.translation_;
  const auto& q = transform.rotation_;
  return {.rotation = Eigen::Quaterniond(q.w_, q.x_, q.y_, q.z_),
          .translation = {t.x_, t.y_, t.z_}};
}

class Ear {
 public:
  explicit Ear(const Robot& robot)
      : transforms_(robot.reader("/tf", tf2_msgs_msg_dds__TFMessage__desc)),
        pose_(robot.reader("/samewhere/pose",
                           geometry_msgs_msg_dds__PoseWithCovarianceStamped__desc)),
        path_(robot.reader("/samewhere/path", nav_msgs_msg_dds__Path__desc)),
        landmarks_(robot.reader("/samewhere/landmarks", sensor_msgs_msg_dds__PointCloud2__desc)),
        grid_(robot.reader("/map", nav_msgs_msg_dds__OccupancyGrid__desc)),
        status_(robot.reader("/samewhere/status", std_msgs_msg_dds__String__desc)),
        diagnostics_(robot.reader("/diagnostics", diagnostic_msgs_msg_dds__DiagnosticArray__desc)) {
  }

  void receive() {
    take_all<tf2_msgs_msg_dds__TFMessage_>(transforms_, [&](const auto& m) { take(m); });
    take_all<geometry_msgs_msg_dds__PoseWithCovarianceStamped_>(pose_, [&](const auto& m) {
      expect(m.header_.frame_id_ == std::string_view("map"), "a pose in the frame map");
      expect(m.pose_.covariance_[0] > 0.0, "a covariance");
      ++counts_["poses"];
    });
    take_all<nav_msgs_msg_dds__Path_>(
        path_, [&](const auto& m) { counts_["keyframes of the path"] = m.poses_._length; });
    take_all<sensor_msgs_msg_dds__PointCloud2_>(landmarks_, [&](const auto& m) {
      expect(m.fields_._length == 4 && m.fields_._buffer[3].name_ == std::string_view("rgb"),
             "points with x, y, z, rgb");
      expect(m.data_._length == m.width_ * m.point_step_, "the bytes of all points");
      counts_["landmarks"] = m.width_;
    });
    take_all<nav_msgs_msg_dds__OccupancyGrid_>(grid_, [&](const auto& m) {
      expect(m.data_._length == m.info_.width_ * m.info_.height_, "a value for each cell");
      counts_["cells of the grid"] = m.data_._length;
    });
    take_all<std_msgs_msg_dds__String_>(status_, [&](const auto& m) {
      if (m.data_ == std::string_view("tracking")) ++counts_["status tracking"];
    });
    take_all<diagnostic_msgs_msg_dds__DiagnosticArray_>(diagnostics_,
                                                        [&](const auto& m) { take(m); });
  }
  const std::map<std::string, std::uint64_t>& counts() const { return counts_; }
  const core::Trajectory& trajectory() const { return trajectory_; }

 private:
  void take(const tf2_msgs_msg_dds__TFMessage_& message) {
    const auto& transforms = message.transforms_;
    expect(transforms._length == 2, "two transforms");
    expect(transforms._buffer[0].child_frame_id_ == std::string_view("odom"), "map -> odom first");
    const auto& stamp = transforms._buffer[1].header_.stamp_;
    trajectory_.push_back(
        {messages::seconds({stamp.sec_, stamp.nanosec_}),
         rigid(transforms._buffer[0].transform_) * rigid(transforms._buffer[1].transform_)});
    ++counts_["transforms"];
  }
  void take(const diagnostic_msgs_msg_dds__DiagnosticArray_& message) {
    for (std::uint32_t i = 0; i < message.status_._length; ++i) {
      const auto& status = message.status_._buffer[i];
      if (status.name_ == std::string_view("samewhere: loop candidate")) {
        expect(status.values_._length >= 5, "a verdict with its values");
        ++counts_["loop verdicts"];
      }
      if (status.message_ == std::string_view("mapping is paused")) ++counts_["answers"];
    }
  }

  dds_entity_t transforms_;
  dds_entity_t pose_;
  dds_entity_t path_;
  dds_entity_t landmarks_;
  dds_entity_t grid_;
  dds_entity_t status_;
  dds_entity_t diagnostics_;
  std::map<std::string, std::uint64_t> counts_ = {{"transforms", 0},
                                                  {"poses", 0},
                                                  {"keyframes of the path", 0},
                                                  {"landmarks", 0},
                                                  {"cells of the grid", 0},
                                                  {"status tracking", 0},
                                                  {"loop verdicts", 0},
                                                  {"answers", 0}};
  core::Trajectory trajectory_;
};

using Send = std::function<void(std::string_view bytes)>;

Send sender(const Robot& robot, const bags::Topic& topic) {
  if (messages::plain_type_name(topic.type) == messages::Image::kType) {
    return [writer = robot.writer(topic.name, sensor_msgs_msg_dds__Image__desc)](
               std::string_view bytes) {
      auto image = messages::read_message<messages::Image>(bytes, messages::Layout::kCdr);
      send(writer, image);
    };
  }
  if (messages::plain_type_name(topic.type) == messages::CameraInfo::kType) {
    return [writer = robot.writer(topic.name, sensor_msgs_msg_dds__CameraInfo__desc)](
               std::string_view bytes) {
      auto info = messages::read_message<messages::CameraInfo>(bytes, messages::Layout::kCdr);
      send(writer, info);
    };
  }
  return [](std::string_view /*bytes*/) {};
}

int play(const std::string& bag_path, const std::string& out) {
  const Robot robot;
  Ear ear(robot);
  const dds_entity_t commands = robot.writer("/samewhere/command", std_msgs_msg_dds__String__desc);
  const auto bag = bags::open_bag(bag_path);
  std::vector<int> topics;
  std::vector<Send> senders;
  for (const bags::Topic& topic : bag->topics()) {
    topics.push_back(static_cast<int>(topics.size()));
    senders.push_back(sender(robot, topic));
  }
  std::this_thread::sleep_for(std::chrono::seconds(3));  // discovery
  bag->start(topics);
  const auto begin = std::chrono::steady_clock::now();
  while (const auto message = bag->next()) {
    std::this_thread::sleep_until(
        begin + std::chrono::nanoseconds(message->log_time_ns - bag->info().first_ns));
    senders[static_cast<std::size_t>(message->topic)](message->bytes);
    ear.receive();
  }
  std::string pause = "pause";
  const std_msgs_msg_dds__String_ command{.data_ = pause.data()};
  checked(dds_write(commands, &command));
  for (int i = 0; i < 60; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    ear.receive();
  }
  for (const auto& [what, count] : ear.counts()) core::print("{}: {}\n", what, count);
  for (const auto& [what, count] : ear.counts()) expect(count > 0, what + ", found none");
  core::write_file(out, core::tum_text(ear.trajectory()));
  return core::kDone;
}

}  // namespace
}  // namespace samewhere

int main(int argc, char** argv) {
  using namespace samewhere;
  return core::run_program("samewhere-typed-robot", [&] {
    if (argc != 3) throw core::InputError("expected BAG TRAJECTORY");
    return play(argv[1], argv[2]);
  });
}
