#include <samewhere/bags/mcap_format.hpp>

namespace samewhere::bags::mcap {
namespace {

// Of messages; stored without a sign. Those of chunks are not checked: they only put chunks in
// order, and of a chunk without messages some recorders write the largest number.
std::int64_t take_time_ns(ByteReader& bytes) {
  const auto time_ns = bytes.number<std::int64_t>();
  if (time_ns < 0) {
    throw core::InputError(fmt::format("a time of {} ns, expected one before the year 2262",
                                       static_cast<std::uint64_t>(time_ns)));
  }
  return time_ns;
}

}  // namespace

Schema read_schema(std::string_view content) {
  ByteReader bytes(content);
  Schema schema;
  schema.id = bytes.number<std::uint16_t>();
  schema.name = bytes.text();
  schema.encoding = bytes.text();
  schema.definition = bytes.text();
  return schema;
}

Channel read_channel(std::string_view content) {
  ByteReader bytes(content);
  Channel channel;
  channel.id = bytes.number<std::uint16_t>();
  channel.schema = bytes.number<std::uint16_t>();
  channel.topic = bytes.text();
  channel.encoding = bytes.text();
  return channel;
}

ChunkHeader read_chunk_header(std::string_view content) {
  ByteReader bytes(content);
  ChunkHeader header;
  header.first_ns = bytes.number<std::int64_t>();
  header.last_ns = bytes.number<std::int64_t>();
  header.size = bytes.number<std::uint64_t>();
  header.crc = bytes.number<std::uint32_t>();
  header.compression = bytes.text();
  header.packed = bytes.bytes(bytes.number<std::uint64_t>());
  return header;
}

ChunkIndex read_chunk_index(std::string_view content) {
  ByteReader bytes(content);
  ChunkIndex index;
  index.first_ns = bytes.number<std::int64_t>();
  index.last_ns = bytes.number<std::int64_t>();
  index.offset = bytes.number<std::uint64_t>();
  index.length = bytes.number<std::uint64_t>();
  bytes.text();  // offsets of message indexes, which has a length of four bytes, too
  bytes.number<std::uint64_t>();  // length of the message indexes
  index.compression = bytes.text();
  return index;
}

Statistics read_statistics(std::string_view content) {
  ByteReader bytes(content);
  Statistics statistics;
  statistics.num_messages = bytes.number<std::uint64_t>();
  bytes.number<std::uint16_t>();  // schemas
  bytes.number<std::uint32_t>();  // channels
  bytes.number<std::uint32_t>();  // attachments
  bytes.number<std::uint32_t>();  // metadata
  statistics.num_chunks = bytes.number<std::uint32_t>();
  statistics.first_ns = take_time_ns(bytes);
  statistics.last_ns = take_time_ns(bytes);
  ByteReader counts(bytes.text());
  while (!counts.is_empty()) {
    const auto channel = counts.number<std::uint16_t>();
    statistics.num_messages_of_channel[channel] = counts.number<std::uint64_t>();
  }
  return statistics;
}

MessageHeader read_message_header(std::string_view content) {
  ByteReader bytes(content);
  MessageHeader header;
  header.channel = bytes.number<std::uint16_t>();
  bytes.number<std::uint32_t>();  // sequence
  header.log_time_ns = take_time_ns(bytes);
  bytes.number<std::int64_t>();  // publish time
  return header;
}

std::string record(Kind kind, std::string_view content) {
  ByteWriter bytes;
  bytes.number(static_cast<std::uint8_t>(kind)).number(std::uint64_t{content.size()});
  return bytes.bytes(content).take();
}

}  // namespace samewhere::bags::mcap
