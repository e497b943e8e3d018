// samewhere-fastdds-robot BAG TRAJECTORY: a robot on another DDS, Fast DDS, which most of ROS 2
// uses: plays the images and camera info of an MCAP bag at real time, receives what a node of
// samewhere tells, counts it and writes the poses of /tf as a TUM file.
//   RATE=0.5       plays slower
//   RELIABLE=1     images are reliable, in packets that fit into one of the network's: for one that
//   loses
//                  packets

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>

#include <samewhere/bags/bag.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/program.hpp>
#include <samewhere/core/terminal.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/library/convert.hpp>
#include <samewhere/node/transforms.hpp>

namespace samewhere {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

// A type whose samples are strings of CDR bytes.
class BytesType final : public dds::TopicDataType {
 public:
  explicit BytesType(const messages::MessageType& type) {
    constexpr std::uint32_t kUsualSize = 4096;
    const std::string name =
        std::string(type.package) + "::msg::dds_::" + std::string(type.name) + "_";
    setName(name.c_str());
    m_typeSize = kUsualSize;
    m_isGetKeyDefined = false;
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const auto& bytes = *static_cast<const std::string*>(data);
    if (bytes.size() > payload->max_size) return false;
    std::memcpy(payload->data, bytes.data(), bytes.size());
    payload->length = static_cast<std::uint32_t>(bytes.size());
    payload->encapsulation = CDR_LE;
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    static_cast<std::string*>(data)->assign(reinterpret_cast<const char*>(payload->data),
                                            payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<std::string*>(data)->size()); };
  }
  void* createData() override { return new std::string; }
  void deleteData(void* data) override { delete static_cast<std::string*>(data); }
  bool getKey(void* /*data*/, rtps::InstanceHandle_t* /*key*/, bool /*force_md5*/) override {
    return false;
  }
};

class Robot {
 public:
  Robot() {
    const char* domain = std::getenv("ROS_DOMAIN_ID");
    auto* factory = dds::DomainParticipantFactory::get_instance();
    dds::DomainParticipantQos qos = dds::PARTICIPANT_QOS_DEFAULT;
    if (is_reliable()) {
      constexpr std::uint32_t kPacketBytes = 1400;
      constexpr std::uint32_t kBufferBytes = 4U << 20U;
      const auto transport = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
      transport->maxMessageSize = kPacketBytes;
      transport->sendBufferSize = kBufferBytes;
      transport->receiveBufferSize = kBufferBytes;
      qos.transport().use_builtin_transports = false;
      qos.transport().user_transports.push_back(transport);
    }
    participant_ = factory->create_participant(
        static_cast<std::uint32_t>(domain == nullptr ? 0 : std::atoi(domain)), qos);
    if (participant_ == nullptr) throw core::InputError("Fast DDS: no participant");
    publisher_ = participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
    subscriber_ = participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
  }
  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;
  ~Robot() {
    participant_->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }

  static bool is_reliable() { return std::getenv("RELIABLE") != nullptr; }

  // Sensor data of ROS 2: best effort, keep last 5.
  dds::DataWriter* writer(const std::string& name, const messages::MessageType& type,
                          bool is_always_reliable) {
    dds::DataWriterQos qos = dds::DATAWRITER_QOS_DEFAULT;
    qos.reliability().kind = is_reliable() || is_always_reliable ? dds::RELIABLE_RELIABILITY_QOS
                                                                 : dds::BEST_EFFORT_RELIABILITY_QOS;
    qos.history().depth = 5;
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    qos.publish_mode().kind = dds::ASYNCHRONOUS_PUBLISH_MODE;
    qos.reliable_writer_qos().times.heartbeatPeriod = eprosima::fastrtps::Duration_t(0.1L);
    return publisher_->create_datawriter(topic(name, type), qos);
  }
  dds::DataReader* reader(const std::string& name, const messages::MessageType& type) {
    dds::DataReaderQos qos = dds::DATAREADER_QOS_DEFAULT;
    qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
    qos.history().depth = 1000;
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    return subscriber_->create_datareader(topic(name, type), qos);
  }

 private:
  dds::Topic* topic(const std::string& name, const messages::MessageType& type) {
    const dds::TypeSupport support(new BytesType(type));
    support.register_type(participant_);
    return participant_->create_topic("rt" + name, support.get_type_name(), dds::TOPIC_QOS_DEFAULT);
  }

  dds::DomainParticipant* participant_ = nullptr;
  dds::Publisher* publisher_ = nullptr;
  dds::Subscriber* subscriber_ = nullptr;
};

template <class Message>
std::vector<Message> take(dds::DataReader* reader) {
  std::vector<Message> taken;
  std::string bytes;
  dds::SampleInfo info;
  while (reader->take_next_sample(&bytes, &info) ==
         eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
    if (info.valid_data)
      taken.push_back(messages::read_message<Message>(bytes, messages::Layout::kCdr));
  }
  return taken;
}

// What the node told.
class Ear {
 public:
  explicit Ear(Robot& robot)
      : transforms_(robot.reader("/tf", messages::type_of<messages::TFMessage>())),
        diagnostics_(robot.reader("/diagnostics", messages::type_of<messages::DiagnosticArray>())),
        status_(robot.reader("/samewhere/status", messages::type_of<messages::String>())),
        path_(robot.reader("/samewhere/path", messages::type_of<messages::Path>())),
        landmarks_(
            robot.reader("/samewhere/landmarks", messages::type_of<messages::PointCloud2>())) {}

  void receive() {
    for (const auto& message : take<messages::TFMessage>(transforms_)) take_transforms(message);
    for (const auto& array : take<messages::DiagnosticArray>(diagnostics_))
      for (const auto& status : array.status) take_diagnostic(status);
    for (const auto& status : take<messages::String>(status_)) last_status_ = status.data;
    for (const auto& path : take<messages::Path>(path_)) num_path_poses_ = path.poses.size();
    for (const auto& cloud : take<messages::PointCloud2>(landmarks_)) num_landmarks_ = cloud.width;
  }

  void tell() const {
    core::print("TF received: {} poses\nloop verdicts received: {} ({} accepted)\n",
                trajectory_.size(), num_verdicts_, num_accepted_);
    core::print("last status: {}\npath: {} keyframes\nlandmarks: {}\n", last_status_,
                num_path_poses_, num_landmarks_);
    core::print("state:");
    for (const auto& value : state_) core::print(" {}={}", value.key, value.value);
    core::print("\nan accepted loop: {}\nanswer to a command: {}\n", example_, answer_);
  }
  const core::Trajectory& trajectory() const { return trajectory_; }

 private:
  void take_transforms(const messages::TFMessage& message) {
    if (message.transforms.size() != 2) return;
    const auto& [map, odom] = std::tie(message.transforms[0], message.transforms[1]);
    const auto map_from_odom = node::pose_from(map.transform.translation, map.transform.rotation);
    const auto odom_from_base =
        node::pose_from(odom.transform.translation, odom.transform.rotation);
    trajectory_.push_back({messages::seconds(odom.header.stamp),
                           library::rigid_of(*map_from_odom * *odom_from_base)});
  }
  void take_diagnostic(const messages::DiagnosticStatus& status) {
    if (status.name == "samewhere: state") state_ = status.values;
    if (status.name == "samewhere: command") answer_ = status.message;
    if (status.name != "samewhere: loop candidate") return;
    ++num_verdicts_;
    if (!status.message.starts_with("accepted")) return;
    ++num_accepted_;
    example_ = status.message;
  }

  dds::DataReader* transforms_;
  dds::DataReader* diagnostics_;
  dds::DataReader* status_;
  dds::DataReader* path_;
  dds::DataReader* landmarks_;
  core::Trajectory trajectory_;
  std::vector<messages::KeyValue> state_;
  std::string last_status_;
  std::string example_;
  std::string answer_;
  std::size_t num_path_poses_ = 0;
  std::size_t num_landmarks_ = 0;
  int num_verdicts_ = 0;
  int num_accepted_ = 0;
};

int play(const std::string& bag_path, const std::string& out) {
  Robot robot;
  Ear ear(robot);
  dds::DataWriter* const commands =
      robot.writer("/samewhere/command", messages::type_of<messages::String>(), true);
  const auto bag = bags::open_bag(bag_path);
  std::vector<int> topics;
  std::vector<dds::DataWriter*> writers;
  for (const bags::Topic& topic : bag->topics()) {
    topics.push_back(static_cast<int>(topics.size()));
    writers.push_back(robot.writer(topic.name, *messages::find_message_type(topic.type), false));
  }
  std::this_thread::sleep_for(std::chrono::seconds(3));  // discovery
  bag->start(topics);
  const char* const rate_text = std::getenv("RATE");
  const double rate = rate_text == nullptr ? 1.0 : std::atof(rate_text);
  const auto begin = std::chrono::steady_clock::now();
  int num_sent = 0;
  while (const auto message = bag->next()) {
    const std::int64_t since_ns = message->log_time_ns - bag->info().first_ns;
    std::this_thread::sleep_until(
        begin + std::chrono::nanoseconds(std::llround(static_cast<double>(since_ns) / rate)));
    std::string bytes(message->bytes);
    writers[static_cast<std::size_t>(message->topic)]->write(&bytes);
    ++num_sent;
    ear.receive();
  }
  std::string command =
      messages::write_message(messages::String{"save_map " + out + ".sw"}, messages::Layout::kCdr);
  commands->write(&command);
  for (int i = 0; i < 40; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    ear.receive();
  }
  core::print("messages sent: {}\n", num_sent);
  ear.tell();
  core::write_file(out, core::tum_text(ear.trajectory()));
  return core::kDone;
}

}  // namespace
}  // namespace samewhere

int main(int argc, char** argv) {
  using namespace samewhere;
  return core::run_program("samewhere-fastdds-robot", [&] {
    if (argc != 3) throw core::InputError("expected BAG TRAJECTORY");
    return play(argv[1], argv[2]);
  });
}
