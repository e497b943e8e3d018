#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include <samewhere/bags/compression.hpp>
#include <samewhere/bags/readers.hpp>
#include <samewhere/bags/ros1_format.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file_reader.hpp>

namespace samewhere::bags {
namespace {

using ros1::HeaderWriter;
using ros1::Op;

constexpr std::size_t kChunkSizeOfRos1 = std::size_t{768} * 1024;  // rosbag's own

class Ros1Writer : public BagWriter {
 public:
  Ros1Writer(const std::filesystem::path& path, Compression compression)
      : file_(path), compression_(compression) {
    if (compression == Compression::kZstd)
      throw core::InputError(path.string() +
                             ": a ROS 1 bag has no zstd, expected none, lz4 or bz2");
    file_.write(ros1::kVersion);
    file_.write(bag_header(0));
  }

  messages::Layout layout() const override { return messages::Layout::kRos1; }

  int add_topic(const std::string& name, const messages::MessageType& type,
                bool is_static) override {
    HeaderWriter about;
    about.text("topic", name).text("type", type.ros1_name()).text("md5sum", type.md5);
    about.text("message_definition", full_definition(type, messages::Layout::kRos1));
    about.text("callerid", "/samewhere").text("latching", is_static ? "1" : "0");
    HeaderWriter header(Op::kConnection);
    header.number("conn", static_cast<std::uint32_t>(connections_.size())).text("topic", name);
    connections_.push_back(header.record(about.view()));
    chunk_.bytes(connections_.back());
    return static_cast<int>(connections_.size()) - 1;
  }

  void write(int topic, std::int64_t log_time_ns, std::string_view bytes) override {
    const auto connection = static_cast<std::uint32_t>(topic);
    index_[connection].emplace_back(log_time_ns, static_cast<std::uint32_t>(chunk_.size()));
    first_ns_ = is_first_ ? log_time_ns : std::min(first_ns_, log_time_ns);
    last_ns_ = is_first_ ? log_time_ns : std::max(last_ns_, log_time_ns);
    is_first_ = false;
    HeaderWriter header(Op::kMessage);
    header.number("conn", connection).time("time", log_time_ns);
    chunk_.bytes(header.record(bytes));
    if (chunk_.size() >= kChunkSizeOfRos1) flush_chunk();
  }

  void finish() override {
    flush_chunk();
    const std::uint64_t index = file_.position();
    for (const std::string& connection : connections_) file_.write(connection);
    for (const std::string& info : chunk_infos_) file_.write(info);
    file_.overwrite(ros1::kVersion.size(), bag_header(index));
    file_.publish();
  }

 private:
  // Filled up, so that it may be written again.
  std::string bag_header(std::uint64_t index) const {
    HeaderWriter header(Op::kBagHeader);
    header.number("index_pos", index);
    header.number("conn_count", static_cast<std::uint32_t>(connections_.size()));
    header.number("chunk_count", static_cast<std::uint32_t>(chunk_infos_.size()));
    const std::size_t lengths = 2 * sizeof(std::uint32_t);
    return header.record(std::string(ros1::kBagHeaderSize - lengths - header.view().size(), ' '));
  }

  void flush_chunk() {
    if (chunk_.size() == 0) return;
    const std::string bytes = chunk_.take();
    const std::uint64_t offset = file_.position();
    HeaderWriter header(Op::kChunk);
    header.text("compression", compression_ == Compression::kNone ? "none" : name_of(compression_));
    header.number("size", static_cast<std::uint32_t>(bytes.size()));
    file_.write(header.record(compress(bytes, compression_)));
    ByteWriter counts;
    for (const auto& [connection, entries] : index_) {
      HeaderWriter index(Op::kIndex);
      index.number("ver", std::uint32_t{1}).number("conn", connection);
      index.number("count", static_cast<std::uint32_t>(entries.size()));
      ByteWriter places;
      for (const auto& [time_ns, place] : entries) {
        const messages::Time time = ros1::recorded_time(time_ns);
        places.number(time.sec).number(time.nanosec).number(place);
      }
      file_.write(index.record(places.view()));
      counts.number(connection).number(static_cast<std::uint32_t>(entries.size()));
    }
    HeaderWriter info(Op::kChunkInfo);
    info.number("ver", std::uint32_t{1}).number("chunk_pos", offset);
    info.time("start_time", first_ns_).time("end_time", last_ns_);
    info.number("count", static_cast<std::uint32_t>(index_.size()));
    chunk_infos_.push_back(info.record(counts.view()));
    index_.clear();
    is_first_ = true;
  }

  core::FileStream file_;
  Compression compression_;
  std::vector<std::string> connections_;  // records
  std::vector<std::string> chunk_infos_;  // records

  ByteWriter chunk_;  // the chunk that is not yet written
  std::map<std::uint32_t, std::vector<std::pair<std::int64_t, std::uint32_t>>> index_;
  bool is_first_ = true;  // no message in it
  std::int64_t first_ns_ = 0;
  std::int64_t last_ns_ = 0;
};

}  // namespace

std::unique_ptr<BagWriter> make_ros1_bag(const std::filesystem::path& path,
                                         Compression compression) {
  return std::make_unique<Ros1Writer>(path, compression);
}

}  // namespace samewhere::bags
