#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include <samewhere/bags/compression.hpp>
#include <samewhere/bags/mcap_format.hpp>
#include <samewhere/bags/readers.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file_reader.hpp>

namespace samewhere::bags {
namespace {

using mcap::Kind;

constexpr std::size_t kChunkSize = std::size_t{4} << 20;

struct WrittenChunk {
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::map<std::uint16_t, std::uint64_t> index_offsets;
  std::uint64_t index_length = 0;
  std::uint64_t packed_size = 0;
  std::uint64_t size = 0;
};

class McapWriter : public BagWriter {
 public:
  McapWriter(const std::filesystem::path& path, Compression compression)
      : file_(path), compression_(compression) {
    if (compression == Compression::kBz2)
      throw core::InputError(path.string() + ": MCAP has no bz2, expected none, lz4 or zstd");
    put(mcap::kMagic);
    ByteWriter header;
    put(mcap::record(Kind::kHeader, header.text("ros2").text("samewhere").view()));
  }

  messages::Layout layout() const override { return messages::Layout::kCdr; }

  int add_topic(const std::string& name, const messages::MessageType& type,
                bool is_static) override {
    const auto id = static_cast<std::uint16_t>(channels_.size() + 1);
    const auto [schema, is_new] =
        schema_of_type_.try_emplace(type.ros2_name(), schemas_.size() + 1);
    if (is_new) {
      ByteWriter bytes;
      bytes.number(static_cast<std::uint16_t>(schema->second)).text(type.ros2_name());
      bytes.text("ros2msg").text(full_definition(type, messages::Layout::kCdr));
      schemas_.push_back(mcap::record(Kind::kSchema, bytes.view()));
      chunk_.bytes(schemas_.back());
    }
    // what rosbag2 reads of a topic besides: by durability 1 a late subscriber gets the last
    // message
    ByteWriter metadata;
    metadata.text("offered_qos_profiles")
        .text(is_static ? "- history: 1\n  depth: 1\n  reliability: 1\n  durability: 1\n" : "");
    ByteWriter bytes;
    bytes.number(id).number(static_cast<std::uint16_t>(schema->second)).text(name).text("cdr");
    bytes.text(metadata.view());
    channels_.push_back(mcap::record(Kind::kChannel, bytes.view()));
    chunk_.bytes(channels_.back());
    sequences_.push_back(0);
    return static_cast<int>(channels_.size()) - 1;
  }

  void write(int topic, std::int64_t log_time_ns, std::string_view bytes) override {
    const auto channel = static_cast<std::uint16_t>(topic + 1);
    index_[channel].emplace_back(log_time_ns, chunk_.size());
    ByteWriter message;
    message.number(channel).number(sequences_.at(static_cast<std::size_t>(topic))++);
    message.number(log_time_ns).number(log_time_ns).bytes(bytes);
    chunk_.bytes(mcap::record(Kind::kMessage, message.view()));
    first_ns_ = is_first_ ? log_time_ns : std::min(first_ns_, log_time_ns);
    last_ns_ = is_first_ ? log_time_ns : std::max(last_ns_, log_time_ns);
    is_first_ = false;
    if (chunk_.size() >= kChunkSize) flush();
  }

  void finish() override {
    flush();
    ByteWriter end;
    put(mcap::record(Kind::kDataEnd, end.number(crc_).view()));
    write_summary();
    put(mcap::kMagic);
    file_.publish();
  }

 private:
  void put(std::string_view bytes) {
    crc_ = crc32_of(bytes, crc_);
    file_.write(bytes);
  }

  void flush() {
    if (chunk_.size() == 0) return;
    const std::string bytes = chunk_.take();
    const std::string packed = compress(bytes, compression_);
    WrittenChunk written{.first_ns = first_ns_,
                         .last_ns = last_ns_,
                         .offset = file_.position(),
                         .index_offsets = {},
                         .packed_size = packed.size(),
                         .size = bytes.size()};
    ByteWriter content;
    content.number(first_ns_).number(last_ns_).number(written.size).number(crc32_of(bytes));
    content.text(name_of(compression_)).number(written.packed_size).bytes(packed);
    put(mcap::record(Kind::kChunk, content.view()));
    written.length = file_.position() - written.offset;
    for (const auto& [channel, entries] : index_) {
      written.index_offsets[channel] = file_.position();
      put(mcap::record(Kind::kMessageIndex, message_index(channel, entries).view()));
      num_messages_[channel] += entries.size();
    }
    written.index_length = file_.position() - written.offset - written.length;
    chunks_.push_back(std::move(written));
    index_.clear();
    is_first_ = true;
  }

  using Entries = std::vector<std::pair<std::int64_t, std::uint64_t>>;  // log time, offset in chunk
  static ByteWriter message_index(std::uint16_t channel, const Entries& entries) {
    ByteWriter places;
    for (const auto& [time_ns, offset] : entries) places.number(time_ns).number(offset);
    ByteWriter index;
    index.number(channel).text(places.view());
    return index;
  }

  std::string statistics() const {
    ByteWriter counts;
    std::uint64_t total = 0;
    for (const auto& [channel, count] : num_messages_) {
      counts.number(channel).number(count);
      total += count;
    }
    std::int64_t first_ns = 0;
    std::int64_t last_ns = 0;
    bool is_first = true;
    for (const WrittenChunk& chunk : chunks_) {
      if (chunk.index_offsets.empty()) continue;
      first_ns = is_first ? chunk.first_ns : std::min(first_ns, chunk.first_ns);
      last_ns = is_first ? chunk.last_ns : std::max(last_ns, chunk.last_ns);
      is_first = false;
    }
    ByteWriter bytes;
    bytes.number(total).number(static_cast<std::uint16_t>(schemas_.size()));
    bytes.number(static_cast<std::uint32_t>(channels_.size())).number(std::uint32_t{0});
    bytes.number(std::uint32_t{0}).number(static_cast<std::uint32_t>(chunks_.size()));
    bytes.number(first_ns).number(last_ns).text(counts.view());
    return mcap::record(Kind::kStatistics, bytes.view());
  }

  static std::string chunk_index(const WrittenChunk& chunk, std::string_view compression) {
    ByteWriter offsets;
    for (const auto& [channel, offset] : chunk.index_offsets)
      offsets.number(channel).number(offset);
    ByteWriter bytes;
    bytes.number(chunk.first_ns).number(chunk.last_ns).number(chunk.offset).number(chunk.length);
    bytes.text(offsets.view()).number(chunk.index_length).text(compression);
    bytes.number(chunk.packed_size).number(chunk.size);
    return mcap::record(Kind::kChunkIndex, bytes.view());
  }

  // Schemas, channels, statistics, chunks; where each of these groups lies; the footer.
  void write_summary() {
    crc_ = 0;
    const std::uint64_t start = file_.position();
    std::string indexes;
    for (const WrittenChunk& chunk : chunks_) indexes += chunk_index(chunk, name_of(compression_));
    std::string schemas;
    for (const std::string& schema : schemas_) schemas += schema;
    std::string channels;
    for (const std::string& channel : channels_) channels += channel;
    const std::pair<Kind, std::string> groups[] = {{Kind::kSchema, std::move(schemas)},
                                                   {Kind::kChannel, std::move(channels)},
                                                   {Kind::kStatistics, statistics()},
                                                   {Kind::kChunkIndex, std::move(indexes)}};
    std::string offsets;
    for (const auto& [kind, group] : groups) {
      if (group.empty()) continue;
      ByteWriter place;
      place.number(static_cast<std::uint8_t>(kind)).number(file_.position());
      offsets +=
          mcap::record(Kind::kSummaryOffset, place.number(std::uint64_t{group.size()}).view());
      put(group);
    }
    const std::uint64_t offsets_start = file_.position();
    put(offsets);
    ByteWriter footer;
    footer.number(static_cast<std::uint8_t>(Kind::kFooter))
        .number(std::uint64_t{mcap::kFooterSize});
    footer.number(start).number(offsets_start);
    footer.number(crc32_of(footer.view(), crc_));  // of the summary and of what is before it here
    put(footer.view());
  }

  core::FileStream file_;
  Compression compression_;
  std::uint32_t crc_ = 0;  // of the data section, then of the summary
  std::map<std::string, std::size_t> schema_of_type_;
  std::vector<std::string> schemas_;   // records
  std::vector<std::string> channels_;  // records
  std::vector<std::uint32_t> sequences_;
  std::map<std::uint16_t, std::uint64_t> num_messages_;
  std::vector<WrittenChunk> chunks_;

  ByteWriter chunk_;  // the chunk that is not yet written
  std::map<std::uint16_t, Entries> index_;
  bool is_first_ = true;  // no message in it
  std::int64_t first_ns_ = 0;
  std::int64_t last_ns_ = 0;
};

}  // namespace

std::unique_ptr<BagWriter> make_mcap(const std::filesystem::path& path, Compression compression) {
  return std::make_unique<McapWriter>(path, compression);
}

}  // namespace samewhere::bags
