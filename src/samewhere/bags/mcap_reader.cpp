#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <samewhere/bags/chunked_reader.hpp>
#include <samewhere/bags/compression.hpp>
#include <samewhere/bags/mcap_format.hpp>
#include <samewhere/bags/readers.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/interrupt.hpp>

namespace samewhere::bags {
namespace {

using core::InputError;
using mcap::Kind;

// Of records that are no chunk: what tells of topics. A message may be as large as a chunk.
constexpr std::uint64_t kMaxRecordSize = std::uint64_t{64} << 20;
// Messages outside of chunks are read in parts of about this size.
constexpr std::uint64_t kLoosePart = std::uint64_t{4} << 20;

struct Record {
  Kind kind = Kind::kHeader;
  std::string_view content;
};

// Takes the next record off `rest`. Throws if it is cut.
Record take_record(ByteReader& rest) {
  const auto kind = rest.number<std::uint8_t>();
  if (kind == 0) throw InputError("a record of kind 0, expected 1 to 255");
  return {static_cast<Kind>(kind), rest.bytes(rest.number<std::uint64_t>())};
}

// What the file says of itself, from its summary or from all of its records.
struct Content {
  std::map<std::uint16_t, mcap::Schema> schemas;
  std::map<std::uint16_t, mcap::Channel> channels;
  mcap::Statistics statistics;
  std::vector<Chunk> chunks;
  std::string compression;
  bool is_closed = true;
  std::string damage;
  bool ends_loose = false;  // the last part of `chunks` is of messages outside of chunks

  // Records that tell of topics; all others are passed over.
  void note(const Record& record) {
    if (record.kind == Kind::kSchema) {
      mcap::Schema schema = mcap::read_schema(record.content);
      schemas.emplace(schema.id, std::move(schema));
    } else if (record.kind == Kind::kChannel) {
      mcap::Channel channel = mcap::read_channel(record.content);
      channels.emplace(channel.id, std::move(channel));
    }
  }
  void count(const mcap::MessageHeader& message) {
    auto& [num_messages, num_chunks, first_ns, last_ns, of_channel] = statistics;
    first_ns = num_messages == 0 ? message.log_time_ns : std::min(first_ns, message.log_time_ns);
    last_ns = num_messages == 0 ? message.log_time_ns : std::max(last_ns, message.log_time_ns);
    ++num_messages;
    ++of_channel[message.channel];
  }
};

class McapReader : public ChunkedReader {
 public:
  explicit McapReader(const std::filesystem::path& path) : ChunkedReader(path) {
    const std::string beginning =
        file().read(0, std::min<std::uint64_t>(file().size(), mcap::kMagic.size()));
    if (beginning != mcap::kMagic) fail("is no MCAP file");
    std::optional<Content> content;
    try {
      content = read_summary();
    } catch (const InputError&) {
      // what the summary should say is read from the records
    }
    take(content ? *std::move(content) : scan());
  }

 protected:
  LoadedChunk load(const Chunk& chunk) override {
    LoadedChunk loaded;
    loaded.bytes = file().read(chunk.offset, chunk.length);
    if (static_cast<Kind>(loaded.bytes.front()) == Kind::kChunk) {
      ByteReader rest(loaded.bytes);
      loaded.bytes = unpack(mcap::read_chunk_header(take_record(rest).content));
    }
    ByteReader rest(loaded.bytes);
    while (!rest.is_empty()) {
      const Record record = take_record(rest);
      if (record.kind != Kind::kMessage) continue;
      const mcap::MessageHeader header = mcap::read_message_header(record.content);
      const auto topic = topic_of_channel_.find(header.channel);
      if (topic == topic_of_channel_.end())
        throw InputError(
            fmt::format("a message of channel {}, which is not declared", header.channel));
      if (!is_selected(topic->second)) continue;
      loaded.entries.push_back(
          {.log_time_ns = header.log_time_ns,
           .topic = topic->second,
           .begin = static_cast<std::size_t>(record.content.data() - loaded.bytes.data()) +
                    mcap::kMessageHeaderSize,
           .size = record.content.size() - mcap::kMessageHeaderSize});
    }
    return loaded;
  }

 private:
  static std::string unpack(const mcap::ChunkHeader& header) {
    std::string bytes = decompress(header.packed, header.compression, header.size);
    if (header.crc != 0 && crc32_of(bytes) != header.crc) {
      throw InputError(fmt::format("a chunk is damaged: its checksum is {:08x}, expected {:08x}",
                                   crc32_of(bytes), header.crc));
    }
    return bytes;
  }

  // Nothing if there is none, or if it does not tell of all chunks and channels.
  std::optional<Content> read_summary() const {
    const std::uint64_t end_size =
        mcap::kRecordHeaderSize + mcap::kFooterSize + mcap::kMagic.size();
    if (file().size() < mcap::kMagic.size() + end_size) return std::nullopt;
    const std::uint64_t footer_offset = file().size() - end_size;
    const std::string end = file().read(footer_offset, end_size);
    if (!end.ends_with(mcap::kMagic)) return std::nullopt;
    ByteReader rest(end);
    const Record footer = take_record(rest);
    if (footer.kind != Kind::kFooter) return std::nullopt;
    const auto start = ByteReader(footer.content).number<std::uint64_t>();
    if (start == 0 || start > footer_offset || footer_offset - start > kMaxRecordSize)
      return std::nullopt;
    const std::string summary = file().read(start, footer_offset - start);
    Content content;
    ByteReader records(summary);
    while (!records.is_empty()) note_summary(take_record(records), content);
    const auto& counts = content.statistics.num_messages_of_channel;
    const bool has_channels = std::all_of(counts.begin(), counts.end(), [&](const auto& count) {
      return content.channels.contains(count.first);
    });
    const bool has_chunks =
        !content.chunks.empty() && content.chunks.size() == content.statistics.num_chunks;
    if (!has_channels || !has_chunks || do_overlap(content.chunks)) return std::nullopt;
    return content;
  }

  void note_summary(const Record& record, Content& content) const {
    content.note(record);
    if (record.kind == Kind::kStatistics)
      content.statistics = mcap::read_statistics(record.content);
    if (record.kind != Kind::kChunkIndex) return;
    const mcap::ChunkIndex index = mcap::read_chunk_index(record.content);
    if (index.length < mcap::kRecordHeaderSize || index.offset > file().size() ||
        index.length > file().size() - index.offset) {
      throw InputError("a chunk outside of the file");
    }
    content.chunks.push_back({index.offset, index.length, index.first_ns, index.last_ns});
    content.compression = index.compression;
  }

  // All records, one after another. A record that is cut ends the file there.
  Content scan() const {
    Content content;
    std::uint64_t offset = mcap::kMagic.size();
    while (offset < file().size()) {
      core::stop_if_interrupted();
      const auto length = record_length(offset);
      if (!length) {
        content.damage = fmt::format("is cut or damaged at byte {}", offset);
        break;
      }
      const auto kind = static_cast<Kind>(file().read(offset, 1).front());
      if (kind == Kind::kFooter) return content;
      try {
        note_record(kind, offset, *length, content);
      } catch (const InputError& error) {
        if (content.damage.empty())
          content.damage = fmt::format("is damaged at byte {}: {}", offset, error.what());
      }
      offset += *length;
    }
    content.is_closed = false;
    return content;
  }

  // With its header; nothing if it does not fit into the file or is none.
  std::optional<std::uint64_t> record_length(std::uint64_t offset) const {
    const std::uint64_t rest = file().size() - offset;
    if (rest < mcap::kRecordHeaderSize) return std::nullopt;
    const std::string header = file().read(offset, mcap::kRecordHeaderSize);
    ByteReader bytes(header);
    if (bytes.number<std::uint8_t>() == 0) return std::nullopt;
    const auto length = bytes.number<std::uint64_t>();
    if (length > rest - mcap::kRecordHeaderSize) return std::nullopt;
    return length + mcap::kRecordHeaderSize;
  }

  void note_record(Kind kind, std::uint64_t offset, std::uint64_t length, Content& content) const {
    if (kind == Kind::kMessage) return note_loose_message(offset, length, content);
    if (kind == Kind::kChunk) return note_chunk(offset, length, content);
    if (kind != Kind::kSchema && kind != Kind::kChannel) return;
    if (length > kMaxRecordSize) throw InputError(fmt::format("a record of {} bytes", length));
    const std::string bytes = file().read(offset, length);
    ByteReader rest(bytes);
    content.note(take_record(rest));
  }

  void note_loose_message(std::uint64_t offset, std::uint64_t length, Content& content) const {
    if (length > kMaxChunkSize) throw InputError(fmt::format("a message of {} bytes", length));
    const std::string bytes = file().read(
        offset,
        std::min<std::uint64_t>(length, mcap::kRecordHeaderSize + mcap::kMessageHeaderSize));
    const auto header =
        mcap::read_message_header(std::string_view(bytes).substr(mcap::kRecordHeaderSize));
    content.count(header);
    const bool is_next = !content.chunks.empty() &&
                         content.chunks.back().offset + content.chunks.back().length == offset &&
                         content.chunks.back().length < kLoosePart && content.ends_loose;
    content.ends_loose = true;
    if (!is_next) {
      content.chunks.push_back({offset, length, header.log_time_ns, header.log_time_ns});
      return;
    }
    Chunk& part = content.chunks.back();
    part.length += length;
    part.first_ns = std::min(part.first_ns, header.log_time_ns);
    part.last_ns = std::max(part.last_ns, header.log_time_ns);
  }

  // One that is damaged is kept: reading it says so, in its turn.
  void note_chunk(std::uint64_t offset, std::uint64_t length, Content& content) const {
    content.ends_loose = false;
    const std::int64_t before_ns = content.chunks.empty() ? 0 : content.chunks.back().last_ns;
    content.chunks.push_back({offset, length, before_ns, before_ns});
    if (length > kMaxChunkSize) throw InputError("a chunk that is too large");
    const std::string record = file().read(offset, length);
    ByteReader whole(record);
    const mcap::ChunkHeader header = mcap::read_chunk_header(take_record(whole).content);
    content.chunks.back().first_ns = header.first_ns;
    content.chunks.back().last_ns = header.last_ns;
    content.compression = header.compression;
    ++content.statistics.num_chunks;
    const std::string bytes = unpack(header);
    ByteReader rest(bytes);
    while (!rest.is_empty()) {
      const Record inner = take_record(rest);
      content.note(inner);
      if (inner.kind == Kind::kMessage) content.count(mcap::read_message_header(inner.content));
    }
  }

  void take(Content content) {
    std::map<std::tuple<std::string, std::string, std::string>, int> known;
    std::map<std::uint16_t, int> order;
    std::vector<Topic> topics;
    for (const auto& [id, channel] : content.channels) {
      const auto found = content.schemas.find(channel.schema);
      const mcap::Schema schema = found == content.schemas.end() ? mcap::Schema{} : found->second;
      const std::string type = messages::plain_type_name(schema.name);
      const auto [place, is_new] = known.try_emplace({channel.topic, type, channel.encoding},
                                                     static_cast<int>(topics.size()));
      if (is_new) topics.push_back({channel.topic, type, channel.encoding, schema.definition, 0});
      order[id] = place->second;
      topics[static_cast<std::size_t>(place->second)].num_messages +=
          content.statistics.num_messages_of_channel[id];
    }
    const std::vector<int> positions =
        set_content({.format = "MCAP",
                     .compression = content.compression.empty() ? "none" : content.compression,
                     .num_messages = content.statistics.num_messages,
                     .first_ns = content.statistics.first_ns,
                     .last_ns = content.statistics.last_ns,
                     .is_closed = content.is_closed,
                     .damage = content.damage},
                    std::move(topics), std::move(content.chunks));
    for (const auto& [id, position] : order)
      topic_of_channel_[id] = positions[static_cast<std::size_t>(position)];
  }

  std::map<std::uint16_t, int> topic_of_channel_;
};

}  // namespace

bool is_mcap(std::string_view beginning) { return beginning.starts_with(mcap::kMagic); }

std::unique_ptr<BagReader> open_mcap(const std::filesystem::path& path) {
  return std::make_unique<McapReader>(path);
}

}  // namespace samewhere::bags
