#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <samewhere/messages/types.hpp>

namespace samewhere::bags {

// What a recording says of one topic. Publishers of one topic with one type are one topic here.
struct Topic {
  std::string name;        // /camera/image_raw
  std::string type;        // sensor_msgs/Image, as messages::plain_type_name has it
  std::string encoding;    // of its messages: "cdr", "ros1", or one that is not read: "json"
  std::string definition;  // of its type; empty: the recording has none
  std::uint64_t num_messages = 0;
};

// How the messages of a topic are laid out. Nothing: in a way that is not read here.
std::optional<messages::Layout> layout_of(const Topic& topic);

struct Message {
  int topic = 0;                 // position in topics()
  std::int64_t log_time_ns = 0;  // when it was recorded; its header has the time of its data
  std::string_view bytes;        // valid until the next call of the reader
};

struct BagInfo {
  std::string format;       // "MCAP", "rosbag2 (SQLite)", "ROS 1 bag"
  std::string compression;  // "none", "zstd", "lz4", "bz2"
  std::uint64_t num_messages = 0;
  std::int64_t first_ns = 0;  // log times; 0 without messages
  std::int64_t last_ns = 0;
  bool is_closed = true;  // false: the recorder was ended before it wrote the index
  std::string damage;     // what is wrong with the file though messages can be read; empty: nothing
};

// A recording of messages, read in the order of their log times, equal ones in the order of the
// file. Memory does not grow with the file: one chunk at a time is held, or those that overlap in
// time. Errors are InputErrors that begin with the path.
class BagReader {
 public:
  BagReader() = default;
  BagReader(const BagReader&) = delete;
  BagReader& operator=(const BagReader&) = delete;
  virtual ~BagReader() = default;

  virtual const BagInfo& info() const = 0;
  // In the order of their names.
  virtual const std::vector<Topic>& topics() const = 0;
  // From the first message on, of these topics alone.
  virtual void start(const std::vector<int>& topics) = 0;
  // The next message, nothing at the end. Before the first start() there is none.
  virtual std::optional<Message> next() = 0;
};

// Whether the file's first bytes or its ending (.mcap, .db3, .bag), or a folder's metadata.yaml,
// are those of a recording that open_bag reads.
bool is_bag(const std::filesystem::path& path);

// An .mcap, .db3 or .bag file, told by its content, or a folder of rosbag2 with its metadata.yaml.
// A file that was not closed is read once to find what is in it. Throws InputError if it is none,
// or damaged where that stands in the way of all of it.
std::unique_ptr<BagReader> open_bag(const std::filesystem::path& path);

enum class BagFormat { kMcap, kSqlite, kRos1 };
enum class Compression { kNone, kLz4, kZstd, kBz2 };

// Writes a recording; it gets its name with finish().
class BagWriter {
 public:
  BagWriter() = default;
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;
  virtual ~BagWriter() = default;

  virtual messages::Layout layout() const = 0;
  // Returns its position. `is_static`: kept for late subscribers, as /tf_static is.
  virtual int add_topic(const std::string& name, const messages::MessageType& type,
                        bool is_static) = 0;
  virtual void write(int topic, std::int64_t log_time_ns, std::string_view bytes) = 0;
  virtual void finish() = 0;

  template <class Payload>
  int add_topic(const std::string& name, bool is_static = false) {
    return add_topic(name, messages::type_of<Payload>(), is_static);
  }
  template <class Payload>
  void write_message(int topic, std::int64_t log_time_ns, const Payload& message) {
    write(topic, log_time_ns, messages::write_message(message, layout()));
  }
};

// One file. Compressions: of MCAP none, lz4, zstd; of ROS 1 none, lz4, bz2; of SQLite none. Throws
// InputError if the compression is another one or the file cannot be made.
std::unique_ptr<BagWriter> make_bag(const std::filesystem::path& path, BagFormat format,
                                    Compression compression);

// metadata.yaml of a folder with one file, as rosbag2 writes it.
std::string rosbag2_metadata(const BagReader& bag, const std::string& file_name);

}  // namespace samewhere::bags
