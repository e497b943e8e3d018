#include <algorithm>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <samewhere/bags/chunked_reader.hpp>
#include <samewhere/bags/compression.hpp>
#include <samewhere/bags/readers.hpp>
#include <samewhere/bags/ros1_format.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/interrupt.hpp>

namespace samewhere::bags {
namespace {

using core::InputError;
using ros1::Op;

struct Connection {
  std::string topic;
  std::string type;
  std::string definition;
  std::uint64_t num_messages = 0;
};

struct BagContent {
  std::map<std::uint32_t, Connection> connections;
  std::vector<Chunk> chunks;
  std::string compression;
  bool is_closed = true;
  std::string damage;

  void note_connection(const ros1::Record& record) {
    const auto id = ros1::number_of<std::uint32_t>(record.header, "conn");
    const ros1::Fields told = ros1::read_fields(record.data);
    connections.try_emplace(
        id, Connection{.topic = std::string(ros1::field(record.header, "topic")),
                       .type = std::string(ros1::field(told, "type")),
                       .definition = std::string(ros1::field(told, "message_definition"))});
  }
};

class Ros1Reader : public ChunkedReader {
 public:
  explicit Ros1Reader(const std::filesystem::path& path) : ChunkedReader(path) {
    const std::uint64_t start = ros1::kVersion.size();
    const std::string version = file().read(0, std::min<std::uint64_t>(file().size(), start));
    if (version != ros1::kVersion) {
      fail(
          fmt::format("is a ROS 1 bag of another version ({}), expected 2.0; `rosbag migrate` or "
                      "`rosbag fix` converts it",
                      version.substr(0, version.find('\n'))));
    }
    take(read_content(start));
  }

 protected:
  LoadedChunk load(const Chunk& chunk) override {
    LoadedChunk loaded;
    {
      const std::string packed = file().read(chunk.offset, chunk.length);
      ByteReader rest(packed);
      loaded.bytes = unpack(ros1::take_record(rest));
    }
    ByteReader rest(loaded.bytes);
    while (!rest.is_empty()) {
      const ros1::Record record = ros1::take_record(rest);
      if (ros1::op_of(record.header) != Op::kMessage) continue;
      const auto connection = ros1::number_of<std::uint32_t>(record.header, "conn");
      const auto topic = topic_of_connection_.find(connection);
      if (topic == topic_of_connection_.end())
        throw InputError(
            fmt::format("a message of connection {}, which is not declared", connection));
      if (!is_selected(topic->second)) continue;
      loaded.entries.push_back(
          {.log_time_ns = ros1::time_ns_of(record.header, "time"),
           .topic = topic->second,
           .begin = static_cast<std::size_t>(record.data.data() - loaded.bytes.data()),
           .size = record.data.size()});
    }
    return loaded;
  }

 private:
  static std::string unpack(const ros1::Record& chunk) {
    if (ros1::op_of(chunk.header) != Op::kChunk) throw InputError("no chunk where one should be");
    return decompress(chunk.data, ros1::field(chunk.header, "compression"),
                      ros1::number_of<std::uint32_t>(chunk.header, "size"));
  }

  BagContent read_content(std::uint64_t start) const {
    std::uint64_t index = 0;
    try {
      index = ros1::number_of<std::uint64_t>(header_at(start), "index_pos");
      if (index != 0) return read_index(index);
    } catch (const InputError&) {
      // what the index should say is read from the records
    }
    return scan(start);
  }

  // With its two lengths; nothing if it does not fit into the file.
  std::optional<std::uint64_t> record_length(std::uint64_t offset) const {
    std::uint64_t end = offset;
    for (int part = 0; part < 2; ++part) {
      if (file().size() - end < sizeof(std::uint32_t)) return std::nullopt;
      const std::string length = file().read(end, sizeof(std::uint32_t));
      end += sizeof(std::uint32_t) + ByteReader(length).number<std::uint32_t>();
      if (end > file().size()) return std::nullopt;
    }
    return end - offset;
  }

  ros1::Fields header_at(std::uint64_t offset) const {
    const std::string length = file().read(offset, sizeof(std::uint32_t));
    const auto size = ByteReader(length).number<std::uint32_t>();
    if (size > ros1::kMaxHeaderSize) throw InputError("a header that is too large");
    return ros1::read_fields(file().read(offset + sizeof(std::uint32_t), size));
  }

  // What stands behind the chunks: connections, and what each chunk holds.
  BagContent read_index(std::uint64_t offset) const {
    if (offset > file().size()) throw InputError("an index behind the end");
    BagContent content;
    while (offset < file().size()) {
      const auto length = record_length(offset);
      if (!length || *length > ros1::kMaxHeaderSize) throw InputError("an index that is cut");
      const std::string bytes = file().read(offset, *length);
      ByteReader rest(bytes);
      const ros1::Record record = ros1::take_record(rest);
      if (ros1::op_of(record.header) == Op::kConnection) content.note_connection(record);
      if (ros1::op_of(record.header) == Op::kChunkInfo) note_chunk_info(record, content);
      offset += *length;
    }
    if (do_overlap(content.chunks)) throw InputError("chunks that overlap");
    if (!content.chunks.empty())
      content.compression = ros1::field(header_at(content.chunks.front().offset), "compression");
    return content;
  }

  void note_chunk_info(const ros1::Record& record, BagContent& content) const {
    const auto offset = ros1::number_of<std::uint64_t>(record.header, "chunk_pos");
    const auto length = offset < file().size() ? record_length(offset) : std::nullopt;
    if (!length) throw InputError("a chunk outside of the file");
    content.chunks.push_back({offset, *length, ros1::time_ns_of(record.header, "start_time"),
                              ros1::time_ns_of(record.header, "end_time")});
    ByteReader counts(record.data);
    while (!counts.is_empty()) {
      const auto connection = content.connections.find(counts.number<std::uint32_t>());
      if (connection == content.connections.end()) throw InputError("a connection without a topic");
      connection->second.num_messages += counts.number<std::uint32_t>();
    }
  }

  BagContent scan(std::uint64_t offset) const {
    BagContent content;
    content.is_closed = false;
    while (offset < file().size()) {
      core::stop_if_interrupted();
      const auto length = record_length(offset);
      const auto op = length ? op_at(offset) : std::nullopt;
      if (!op) {
        content.damage = fmt::format("is cut or damaged at byte {}", offset);
        break;
      }
      try {
        note_record(*op, offset, *length, content);
      } catch (const InputError& error) {
        content.damage = fmt::format("is damaged at byte {}: {}", offset, error.what());
      }
      offset += *length;
    }
    return content;
  }

  // Nothing where there is no record.
  std::optional<Op> op_at(std::uint64_t offset) const {
    try {
      return ros1::op_of(header_at(offset));
    } catch (const InputError&) {
      return std::nullopt;
    }
  }

  void note_record(Op op, std::uint64_t offset, std::uint64_t length, BagContent& content) const {
    if (op != Op::kConnection && op != Op::kChunk) return;
    if (length > kMaxChunkSize) throw InputError("a record that is too large");
    const std::string bytes = file().read(offset, length);
    ByteReader rest(bytes);
    const ros1::Record record = ros1::take_record(rest);
    if (op == Op::kConnection) return content.note_connection(record);
    const std::int64_t before_ns = content.chunks.empty() ? 0 : content.chunks.back().last_ns;
    content.chunks.push_back({offset, length, before_ns, before_ns});
    content.compression = ros1::field(record.header, "compression");
    const std::string inner_bytes = unpack(record);
    ByteReader inner(inner_bytes);
    bool is_first = true;
    while (!inner.is_empty()) note_inner(ros1::take_record(inner), content, is_first);
  }

  static void note_inner(const ros1::Record& record, BagContent& content, bool& is_first) {
    const Op op = ros1::op_of(record.header);
    if (op == Op::kConnection) content.note_connection(record);
    if (op != Op::kMessage) return;
    const auto known =
        content.connections.find(ros1::number_of<std::uint32_t>(record.header, "conn"));
    if (known == content.connections.end()) throw InputError("a message that is not declared");
    ++known->second.num_messages;
    const std::int64_t time_ns = ros1::time_ns_of(record.header, "time");
    Chunk& chunk = content.chunks.back();
    chunk.first_ns = is_first ? time_ns : std::min(chunk.first_ns, time_ns);
    chunk.last_ns = is_first ? time_ns : std::max(chunk.last_ns, time_ns);
    is_first = false;
  }

  void take(BagContent content) {
    std::map<std::pair<std::string, std::string>, int> known;
    std::map<std::uint32_t, int> order;
    std::vector<Topic> topics;
    BagInfo info{.format = "ROS 1 bag",
                 .compression = content.compression.empty() ? "none" : content.compression,
                 .is_closed = content.is_closed,
                 .damage = content.damage};
    for (const auto& [id, connection] : content.connections) {
      const auto [place, is_new] =
          known.try_emplace({connection.topic, connection.type}, static_cast<int>(topics.size()));
      if (is_new)
        topics.push_back({connection.topic, connection.type, "ros1", connection.definition, 0});
      order[id] = place->second;
      topics[static_cast<std::size_t>(place->second)].num_messages += connection.num_messages;
      info.num_messages += connection.num_messages;
    }
    for (const Chunk& chunk : content.chunks) {
      const bool is_first = &chunk == &content.chunks.front();
      info.first_ns = is_first ? chunk.first_ns : std::min(info.first_ns, chunk.first_ns);
      info.last_ns = is_first ? chunk.last_ns : std::max(info.last_ns, chunk.last_ns);
    }
    const std::vector<int> positions =
        set_content(std::move(info), std::move(topics), std::move(content.chunks));
    for (const auto& [id, position] : order)
      topic_of_connection_[id] = positions[static_cast<std::size_t>(position)];
  }

  std::map<std::uint32_t, int> topic_of_connection_;
};

}  // namespace

bool is_ros1_bag(std::string_view beginning) {
  return beginning.starts_with("#ROSBAG V") || beginning.starts_with("#ROSRECORD V");
}

std::unique_ptr<BagReader> open_ros1_bag(const std::filesystem::path& path) {
  return std::make_unique<Ros1Reader>(path);
}

}  // namespace samewhere::bags
