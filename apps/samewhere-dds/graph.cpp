#include "graph.hpp"

#include <array>
#include <cstdlib>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "raw_type.hpp"
#include <samewhere/core/errors.hpp>

namespace samewhere::dds_node {
namespace {

dds_entity_t checked(dds_entity_t entity, const std::string& what) {
  if (entity < 0) throw core::InputError(fmt::format("DDS: {}: {}", what, dds_strretcode(-entity)));
  return entity;
}

using Qos = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;

Qos qos_of(const node::Quality& quality) {
  Qos qos(dds_create_qos(), &dds_delete_qos);
  dds_qset_reliability(qos.get(),
                       quality.is_reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       DDS_MSECS(100));
  dds_qset_durability(qos.get(),
                      quality.is_kept ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, quality.depth);
  if (quality.is_kept) {
    dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, quality.depth,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  }
  dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
  return qos;
}

// Names of ROS 2's types and topics in DDS.
std::string dds_type(const messages::MessageType& type) {
  return fmt::format("{}::msg::dds_::{}_", type.package, type.name);
}

std::string dds_topic(const std::string& name) { return "rt" + name; }

// An image comes as hundreds of packets at once. CYCLONEDDS_URI, where it is set, has the last
// word.
int join(int domain) {
  constexpr const char* kLargeBuffers =
      "<CycloneDDS><Domain><Internal><SocketReceiveBufferSize max=\"16MB\"/></Internal></Domain>"
      "</CycloneDDS>";
  const auto id = static_cast<dds_domainid_t>(domain);
  const std::string what = fmt::format("domain {} cannot be joined", domain);
  if (std::getenv("CYCLONEDDS_URI") == nullptr) checked(dds_create_domain(id, kLargeBuffers), what);
  return checked(dds_create_participant(id, nullptr, nullptr), what);
}

}  // namespace

Graph::Graph(int domain)
    : participant_(join(domain)),
      waitset_(checked(dds_create_waitset(participant_), "no waitset")) {}

Graph::~Graph() { dds_delete(participant_); }

int Graph::topic(const std::string& name, const messages::MessageType& type) const {
  return checked(create_raw_topic(participant_, dds_topic(name), dds_type(type)),
                 name + " is no topic of the type " + type.ros2_name());
}

void Graph::subscribe(const std::string& name, const messages::MessageType& type,
                      const node::Quality& quality, Receive receive) {
  const Qos qos = qos_of(quality);
  const dds_entity_t reader =
      checked(dds_create_reader(participant_, topic(name, type), qos.get(), nullptr), name);
  checked(dds_set_status_mask(reader, DDS_DATA_AVAILABLE_STATUS), name);
  checked(dds_waitset_attach(waitset_, reader, reader), name);
  readers_.push_back({reader, name, std::move(receive)});
}

int Graph::advertise(const std::string& name, const messages::MessageType& type,
                     const node::Quality& quality) {
  const Qos qos = qos_of(quality);
  writers_.push_back(
      checked(dds_create_writer(participant_, topic(name, type), qos.get(), nullptr), name));
  return static_cast<int>(writers_.size()) - 1;
}

// A subscriber that does not keep up costs the message, as with ROS 2.
void Graph::publish(int writer, const std::string& cdr) const {
  dds_write(writers_[static_cast<std::size_t>(writer)], &cdr);
}

void Graph::spin(double seconds) {
  constexpr double kNanoseconds = 1e9;
  const auto timeout = static_cast<dds_duration_t>(seconds * kNanoseconds);
  if (dds_waitset_wait(waitset_, nullptr, 0, timeout) <= 0) return;
  for (Reader& reader : readers_) take_from(reader);
}

void Graph::take_from(Reader& reader) {
  constexpr std::uint32_t kAtATime = 16;
  std::array<ddsi_serdata*, kAtATime> samples{};
  std::array<dds_sample_info_t, kAtATime> infos{};
  std::uint32_t status = 0;
  dds_take_status(reader.entity, &status, DDS_DATA_AVAILABLE_STATUS);
  dds_return_t count = 0;
  do {
    count = dds_takecdr(reader.entity, samples.data(), kAtATime, infos.data(), DDS_ANY_STATE);
    for (dds_return_t i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      try {
        if (infos[at].valid_data) reader.receive(bytes_of(samples[at]));
      } catch (const core::InputError& error) {
        if (!std::exchange(reader.has_warned, true))
          spdlog::warn("{}: {}", reader.name, error.what());
      }
      release(samples[at]);
    }
  } while (count > 0);
}

}  // namespace samewhere::dds_node
