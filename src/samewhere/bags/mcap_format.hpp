#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include <samewhere/bags/bytes.hpp>

// Records of an MCAP file, as its specification has them (mcap.dev, version 0): one byte that names
// the kind, eight bytes of length, the content.
namespace samewhere::bags::mcap {

inline constexpr std::string_view kMagic = "\x89MCAP0\r\n";
inline constexpr std::size_t kRecordHeaderSize = 9;
inline constexpr std::size_t kFooterSize = 20;

enum class Kind : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

struct Schema {
  std::uint16_t id = 0;
  std::string name;
  std::string encoding;  // ros2msg, ros1msg, ...
  std::string definition;
};

struct Channel {
  std::uint16_t id = 0;
  std::uint16_t schema = 0;  // 0: has none
  std::string topic;
  std::string encoding;  // of its messages
};

struct ChunkHeader {
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
  std::uint64_t size = 0;  // uncompressed
  std::uint32_t crc = 0;   // of the uncompressed bytes; 0: not known
  std::string_view compression;
  std::string_view packed;
};

struct ChunkIndex {
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
  std::uint64_t offset = 0;  // of the chunk's record
  std::uint64_t length = 0;
  std::string compression;
};

struct Statistics {
  std::uint64_t num_messages = 0;
  std::uint32_t num_chunks = 0;
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
  std::map<std::uint16_t, std::uint64_t> num_messages_of_channel;
};

struct MessageHeader {
  std::uint16_t channel = 0;
  std::int64_t log_time_ns = 0;
};
inline constexpr std::size_t kMessageHeaderSize = 22;  // channel, sequence, log and publish time

// From the content of a record. They throw InputError, without the name of the file.
Schema read_schema(std::string_view content);
Channel read_channel(std::string_view content);
ChunkHeader read_chunk_header(std::string_view content);
ChunkIndex read_chunk_index(std::string_view content);
Statistics read_statistics(std::string_view content);
MessageHeader read_message_header(std::string_view content);

// A record with its kind and length.
std::string record(Kind kind, std::string_view content);

}  // namespace samewhere::bags::mcap
